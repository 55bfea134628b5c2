#include "contact/stations/flank_gap.h"

#include <algorithm>

namespace elastogear::contact {
namespace {

constexpr double kDifference = 1e-6;  // of the height of the flank, for slopes of deviations and edges
constexpr double kPlaceShift = 1e-4;  // of that height, more than a place moves by such a difference

double beyond(double x, double from, double to) { return std::max({from - x, x - to, 0.}); }

// m: what rounded edges take away. A parabola of the edge's radius beyond the tip and beyond both ends of the
// face.
double taken_by_edges(const ExactFlanks::Extent& extent, const Strip& face, double v, double z) {
  const double at_tip = std::max(extent.tip_at_upper ? v - extent.upper : extent.lower - v, 0.);
  const double at_end = beyond(z, face.from, face.to);
  return (at_tip * at_tip + at_end * at_end) / (2 * extent.edge_radius);
}

}  // namespace

FlankGap::FlankGap(const FlankPair& flanks, const RelativePlacement& placement, const FaceEnds& ends)
    : flanks_(flanks),
      placement_(placement),
      ends_(ends),
      owner_(flanks.owner->extent()),
      mate_(flanks.mate->extent()) {}

FlankGap::Seen FlankGap::seen(double v, double z) const {
  Seen seen{flanks_.owner->point(flanks_.on_owner, v, z), {}, {}};
  seen.x_mate = placement_.R.transpose() * (seen.owner.x - placement_.r);
  seen.mate = flanks_.mate->distance(flanks_.on_mate, seen.x_mate);
  return seen;
}

double FlankGap::added_by_mate(double v, double z) const {
  return taken_by_edges(mate_, ends_.mate, v, z) - flanks_.mate->deviation(flanks_.on_mate, v, z);
}

double FlankGap::added_by_owner(double v, double z) const {
  return taken_by_edges(owner_, ends_.owner, v, z) - flanks_.owner->deviation(flanks_.on_owner, v, z);
}

double FlankGap::added(double v, double z, const Seen& seen) const {
  return added_by_owner(v, z) + added_by_mate(seen.mate.v, mate_z(seen));
}

bool FlankGap::mate_is_plain_around(const Seen& seen) const {
  const double near = kPlaceShift * (mate_.upper - mate_.lower), v = seen.mate.v, z = mate_z(seen);
  return added_by_mate(v, z) == 0 && added_by_mate(v + near, z) == 0 && added_by_mate(v - near, z) == 0 &&
         added_by_mate(v, z + near) == 0 && added_by_mate(v, z - near) == 0;
}

Eigen::Vector3d FlankGap::mate_normal(const Seen& seen) const {
  const double h = kDifference * (mate_.upper - mate_.lower);
  Eigen::Vector3d n = seen.mate.gradient;
  if (mate_is_plain_around(seen)) return n;
  const auto added_at = [&](const Eigen::Vector3d& x) {
    return added_by_mate(flanks_.mate->distance(flanks_.on_mate, x).v,
                         flanks_.mate->chart(flanks_.on_mate, x)[1]);
  };
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(k);
    n[k] += (added_at(seen.x_mate + step) - added_at(seen.x_mate - step)) / (2 * h);
  }
  return n;
}

double FlankGap::at(double v, double z) const {
  const Seen seen = this->seen(v, z);
  return seen.mate.distance + added(v, z, seen);
}

double FlankGap::without_edges(double v, double z) const {
  const Seen seen = this->seen(v, z);
  return seen.mate.distance - flanks_.owner->deviation(flanks_.on_owner, v, z) -
         flanks_.mate->deviation(flanks_.on_mate, seen.mate.v, mate_z(seen));
}

double FlankGap::taken(bool of_owner, double v, double z) const {
  return of_owner ? taken_by_edges(owner_, ends_.owner, v, z) : taken_by_edges(mate_, ends_.mate, v, z);
}

double FlankGap::added_slope(double v, double z, int along, const Seen& seen) const {
  const double h = kDifference * height(), h_v = along == 0 ? h : 0, h_z = along == 1 ? h : 0;
  if (mate_is_plain_around(seen))
    return (added_by_owner(v + h_v, z + h_z) - added_by_owner(v - h_v, z - h_z)) / (2 * h);
  return (added(v + h_v, z + h_z, this->seen(v + h_v, z + h_z)) -
          added(v - h_v, z - h_z, this->seen(v - h_v, z - h_z))) /
         (2 * h);
}

double FlankGap::slope_v(double v, double z) const {
  const Seen seen = this->seen(v, z);
  return (placement_.R * seen.mate.gradient).dot(seen.owner.x_v) + added_slope(v, z, 0, seen);
}

double FlankGap::slope_z(double v, double z) const {
  const Seen seen = this->seen(v, z);
  return (placement_.R * seen.mate.gradient).dot(seen.owner.x_z) + added_slope(v, z, 1, seen);
}

}  // namespace elastogear::contact
