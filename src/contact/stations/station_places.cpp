#include "elastogear/contact/station_places.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "elastogear/base/rotation.h"

namespace elastogear::contact {
namespace {

constexpr int kMostSteps = 60;
constexpr double kSolved = 1e-13;     // of the height of the flank, its place
constexpr double kRateStep = 1e-5;    // of the height of the flank, by which the mate is moved for rates
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
  // Normal of the mate's flank with its deviation and rounded edge, which is the gradient of the gap. Its
  // length is 1 to second order of their slope.
  Eigen::Vector3d mate_normal(const Seen& seen) const {
    const double h = kDifference * (mate_.upper - mate_.lower), v = seen.mate.v;
    const double slope = (added_by_mate(v + h, seen) - added_by_mate(v - h, seen)) / (2 * h);
    if (slope == 0) return seen.mate.gradient;
    return seen.mate.gradient + slope * flanks_.mate->point(flanks_.on_mate, v, mate_z(seen)).x_v;
  }
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
  // m: ends of the flank, with its rounded edge.
  double low() const { return owner_.lower - (owner_.tip_at_upper ? 0 : owner_.edge_radius); }
  double high() const { return owner_.upper + (owner_.tip_at_upper ? owner_.edge_radius : 0); }
  // Place of the least gap: the zero of its derivative between the ends of the flank with its rounded edge.
  // The method of Illinois: secants of an interval, whose end counts half when it stays.
  double least() const {
    double low = this->low(), high = this->high(), at_low = slope(low), at_high = slope(high);
    if (at_low >= 0) return low;
    if (at_high <= 0) return high;
    const double solved = kSolved * (high - low);
    double last = low;
    int stayed = 0;  // which end stayed last
    for (int step = 0; step < kMostSteps && high - low > solved; ++step) {
      const double v =
          step % 8 == 7 ? (low + high) / 2 : (low * at_high - high * at_low) / (at_high - at_low);
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
    return taken_by_edge(owner_, v) - flanks_.owner->deviation(flanks_.on_owner, v, z_) +
           added_by_mate(seen.mate.v, seen);
  }
  double added_by_mate(double v, const Seen& seen) const {
    return taken_by_edge(mate_, v) - flanks_.mate->deviation(flanks_.on_mate, v, mate_z(seen));
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
    places.push_back(
        {strip, v, seen.mate.v, gap.mate_z(seen), gap.at(v), placement.R * gap.mate_normal(seen)});
  }
  return places;
}

double opening(const FlankPair& flanks, const RelativePlacement& placement, const NearestPlace& place,
               double h) {
  const Gap gap(flanks, placement, place.face.centre());
  const double v = std::max(place.v, h);  // involutes begin at 0
  return (gap.at(v + h) + gap.at(v - h)) / 2 - gap.at(v);
}

PlaceRates place_rates(const FlankPair& flanks, const RelativePlacement& placement, const NearestPlace& place,
                       const Eigen::Matrix<double, 6, 1>& twist, double h) {
  const ExactFlanks::Extent extent = flanks.owner->extent();
  const double small = kRateStep * (extent.upper - extent.lower), z = place.face.centre();
  const double speed = twist.head<3>().norm() + twist.tail<3>().norm() * placement.r.norm();
  if (speed == 0) return {0, 0, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 0};
  const double time = small / speed;
  const Gap here(flanks, placement, z);
  const double v = std::max(place.v, 2 * small), bend = here.slope(v + small) - here.slope(v - small);
  const Eigen::Vector3d angle = time * twist.tail<3>();
  const Eigen::Matrix3d turn = rotation_matrix(angle);
  const RelativePlacement moved{turn * placement.R, turn * placement.r + time * twist.head<3>()};
  const Gap there(flanks, moved, z);
  PlaceRates rates{};
  const bool is_free = place.v > here.low() && place.v < here.high();
  if (is_free && bend > 0) rates.v = -(there.slope(v) - here.slope(v)) * 2 * small / bend / time;
  const double to = v + time * rates.v;
  const Gap::Seen seen_here = here.seen(v), seen_there = there.seen(to);
  const Eigen::Vector3d n_here = here.mate_normal(seen_here), n_there = there.mate_normal(seen_there);
  rates.mate_v = (seen_there.mate.v - seen_here.mate.v) / time;
  rates.mate_n = (n_there - n_here) / time;
  rates.n = (moved.R * n_there - placement.R * n_here) / time;
  const auto opens = [&](const Gap& gap, double at) {
    const double c = std::max(at, h);
    return (gap.at(c + h) + gap.at(c - h)) / 2 - gap.at(c);
  };
  rates.opening = (opens(there, to) - opens(here, v)) / time;
  return rates;
}

LineScale line_scale(const FlankPoint& point, double slope) {
  const double along = (point.x_v * slope + point.x_z).norm();
  return {along, point.x_v.cross(point.x_z).norm() / along};
}

}  // namespace elastogear::contact
