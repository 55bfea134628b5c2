#include "elastogear/contact/station_places.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace elastogear::contact {
namespace {

constexpr int kMostSteps = 60;
constexpr double kSolved = 1e-9;      // of the height of the flank, its place
constexpr double kDifference = 1e-6;  // of the height of the flank, for slopes of deviations

// m: what a rounded edge of the tip takes away at v. A parabola of the edge's radius.
double taken_by_edge(const ExactFlanks::Extent& extent, double v) {
  const double beyond = extent.tip_at_upper ? v - extent.upper : extent.lower - v;
  return beyond > 0 ? beyond * beyond / (2 * extent.edge_radius) : 0;
}

// The gap between two flanks over v of the owner, at one z.
class Gap {
 public:
  Gap(const FlankPair& flanks, const RelativePlacement& placement, double z)
      : flanks_(flanks),
        placement_(placement),
        z_(z),
        owner_(flanks.owner->extent()),
        mate_(flanks.mate->extent()) {}

  struct Seen {
    FlankPoint owner;
    Eigen::Vector3d x_mate;  // m
    FlankDistance mate;
  };
  Seen seen(double v) const {
    Seen seen{flanks_.owner->point(flanks_.on_owner, v, z_), {}, {}};
    seen.x_mate = placement_.R.transpose() * (seen.owner.x - placement_.r);
    seen.mate = flanks_.mate->distance(flanks_.on_mate, seen.x_mate);
    return seen;
  }
  double mate_z(const Seen& seen) const { return flanks_.mate->chart(seen.x_mate)[1]; }
  double at(double v) const {
    const Seen seen = this->seen(v);
    return seen.mate.distance + added(v, seen);
  }
  // Its derivative; that of what is added, by differences.
  double slope(double v) const {
    const double h = kDifference * (owner_.upper - owner_.lower);
    const Seen seen = this->seen(v);
    return (placement_.R * seen.mate.gradient).dot(seen.owner.x_v) +
           (added(v + h, this->seen(v + h)) - added(v - h, this->seen(v - h))) / (2 * h);
  }
  // Where it is least: the derivative's zero between the ends of the flank and its rounded edge, by the
  // secant of its ends, of which one that stays counts half (Illinois).
  double least() const {
    double low = owner_.lower - (owner_.tip_at_upper ? 0 : owner_.edge_radius);
    double high = owner_.upper + (owner_.tip_at_upper ? owner_.edge_radius : 0);
    double at_low = slope(low), at_high = slope(high);
    if (at_low >= 0) return low;
    if (at_high <= 0) return high;
    const double solved = kSolved * (high - low);
    double last = low;
    int stayed = 0;  // which end stayed last
    for (int step = 0; step < kMostSteps && high - low > solved; ++step) {
      const double v = step % 8 == 7 ? (low + high) / 2 : (low * at_high - high * at_low) / (at_high - at_low);
      const double here = slope(v);
      if (here == 0) return v;
      const bool below = here < 0;
      (below ? low : high) = v;
      (below ? at_low : at_high) = here;
      if (stayed == (below ? 1 : -1)) (below ? at_high : at_low) /= 2;
      stayed = below ? 1 : -1;
      if (std::abs(v - last) <= solved) return v;
      last = v;
    }
    return (low * at_high - high * at_low) / (at_high - at_low);
  }

 private:
  // m: what edges take away and deviations of both flanks add.
  double added(double v, const Seen& seen) const {
    return taken_by_edge(owner_, v) + taken_by_edge(mate_, seen.mate.v) -
           flanks_.owner->deviation(flanks_.on_owner, v, z_) -
           flanks_.mate->deviation(flanks_.on_mate, seen.mate.v, mate_z(seen));
  }

  const FlankPair& flanks_;
  const RelativePlacement& placement_;
  double z_;
  ExactFlanks::Extent owner_, mate_;
};

}  // namespace

std::vector<NearestPlace> nearest_places(const FlankPair& flanks, const RelativePlacement& placement,
                                         const std::vector<Strip>& strips) {
  std::vector<NearestPlace> places;
  for (const Strip& strip : strips) {
    const Gap gap(flanks, placement, strip.centre());
    const double v = gap.least();
    const Gap::Seen seen = gap.seen(v);
    places.push_back({strip, v, seen.mate.v, gap.mate_z(seen), gap.at(v),
                      (placement.R * seen.mate.gradient).normalized()});
  }
  return places;
}

double opening(const FlankPair& flanks, const RelativePlacement& placement, const NearestPlace& place,
               double h) {
  const Gap gap(flanks, placement, place.face.centre());
  const double v = std::max(place.v, h);  // involutes begin at 0
  return (gap.at(v + h) + gap.at(v - h)) / 2 - gap.at(v);
}

LineScale line_scale(const FlankPoint& point, double slope) {
  const double along = (point.x_v * slope + point.x_z).norm();
  return {along, point.x_v.cross(point.x_z).norm() / along};
}

}  // namespace elastogear::contact
