#include "elastogear/contact/station_places.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "contact/stations/flank_gap.h"
#include "elastogear/base/rotation.h"

namespace elastogear::contact {
namespace {

constexpr int kMostSteps = 60;
constexpr double kSolved = 1e-13;    // of the height of the flank, its place
constexpr double kNearGuess = 0.02;  // of that height, from strip to strip
constexpr double kRateStep = 1e-5;   // of the height of the flank, by which the mate is moved for rates

// Slopes of the gap at both ends of an interval.
struct Bracket {
  double low, high, at_low, at_high;

  Bracket(const FlankGap& gap, double z, double from, double to)
      : low(from), high(to), at_low(gap.slope_v(from, z)), at_high(gap.slope_v(to, z)) {}
  bool holds_zero() const { return at_low < 0 && at_high > 0; }
};

// The zero of the gap's slope. The method of Illinois: secants of an interval, whose end counts half when it
// stays.
double zero_between(const FlankGap& gap, double z, Bracket b) {
  const double solved = kSolved * gap.height();
  double last = b.low;
  int stayed = 0;  // which end stayed last
  for (int step = 0; step < kMostSteps && b.high - b.low > solved; ++step) {
    const double v = step % 8 == 7 ? (b.low + b.high) / 2
                                   : (b.low * b.at_high - b.high * b.at_low) / (b.at_high - b.at_low);
    const double here = gap.slope_v(v, z);
    if (here == 0) return v;
    const bool below = here < 0;
    (below ? b.low : b.high) = v;
    (below ? b.at_low : b.at_high) = here;
    if (stayed == (below ? 1 : -1)) (below ? b.at_high : b.at_low) /= 2;
    stayed = below ? 1 : -1;
    if (std::abs(v - last) <= solved) return v;
    last = v;
  }
  return (b.low * b.at_high - b.high * b.at_low) / (b.at_high - b.at_low);
}

// Place of the least gap at one z, between the ends of the flank with its rounded edge; near `guess`, that of
// the strip before, if it is there.
double least(const FlankGap& gap, double z, std::optional<double> guess) {
  const double low = gap.low(), high = gap.high(), near = kNearGuess * gap.height();
  if (guess && *guess - near > low && *guess + near < high)
    if (const Bracket beside(gap, z, *guess - near, *guess + near); beside.holds_zero())
      return zero_between(gap, z, beside);
  const Bracket whole(gap, z, low, high);
  if (whole.at_low >= 0) return low;
  if (whole.at_high <= 0) return high;
  return zero_between(gap, z, whole);
}

// m: the mean by which the gap opens at the distances h to both sides across the profile.
double opens(const FlankGap& gap, double v, double z, double h) {
  const double c = std::max(v, h);  // involutes begin at 0
  return (gap.at(c + h, z) + gap.at(c - h, z)) / 2 - gap.at(c, z);
}

}  // namespace

NearestPlace place_at(const FlankGap& gap, const Strip& face, double v) {
  const double z = face.centre();
  const FlankGap::Seen seen = gap.seen(v, z);
  return {face,
          v,
          seen.mate.v,
          gap.mate_z(seen),
          gap.at(v, z),
          gap.without_edges(v, z),
          gap.placement().R * gap.mate_normal(seen)};
}

RelativePlacement moved(const RelativePlacement& placement, const Eigen::Matrix<double, 6, 1>& twist,
                        double time) {
  const Eigen::Matrix3d turn = rotation_matrix(Eigen::Vector3d(time * twist.tail<3>()));
  return {turn * placement.R, turn * placement.r + time * twist.head<3>()};
}

double rate_time(const FlankPair& flanks, const RelativePlacement& placement,
                 const Eigen::Matrix<double, 6, 1>& twist) {
  const ExactFlanks::Extent extent = flanks.owner->extent();
  const double speed = twist.head<3>().norm() + twist.tail<3>().norm() * placement.r.norm();
  return speed > 0 ? kRateStep * (extent.upper - extent.lower) / speed : 0;
}

std::vector<NearestPlace> nearest_places(const FlankPair& flanks, const RelativePlacement& placement,
                                         const std::vector<Strip>& strips, const FaceEnds& ends) {
  const FlankGap gap(flanks, placement, ends);
  std::vector<NearestPlace> places;
  std::optional<double> guess;
  for (const Strip& strip : strips) {
    guess = least(gap, strip.centre(), guess);
    places.push_back(place_at(gap, strip, *guess));
  }
  return places;
}

double opening(const FlankPair& flanks, const RelativePlacement& placement, const NearestPlace& place,
               double h) {
  return opens(FlankGap(flanks, placement), place.v, place.face.centre(), h);
}

PlaceRates place_rates(const FlankPair& flanks, const RelativePlacement& placement, const NearestPlace& place,
                       const Eigen::Matrix<double, 6, 1>& twist, double h) {
  const double time = rate_time(flanks, placement, twist), z = place.face.centre();
  if (time == 0) return {0, 0, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 0};
  const FlankGap here(flanks, placement);
  const double small = kRateStep * here.height(), v = std::max(place.v, 2 * small);
  const double bend = here.slope_v(v + small, z) - here.slope_v(v - small, z);
  const RelativePlacement earlier = moved(placement, twist, -time), later = moved(placement, twist, time);
  const FlankGap before(flanks, earlier), after(flanks, later);
  PlaceRates rates{};
  const bool is_free = place.v > here.low() && place.v < here.high();
  if (is_free && bend > 0) rates.v = -(after.slope_v(v, z) - before.slope_v(v, z)) * small / bend / time;
  const double way = time * rates.v, span = 2 * time;
  const FlankGap::Seen from = before.seen(v - way, z), to = after.seen(v + way, z);
  const Eigen::Vector3d n_from = before.mate_normal(from), n_to = after.mate_normal(to);
  rates.mate_v = (to.mate.v - from.mate.v) / span;
  rates.mate_n = (n_to - n_from) / span;
  rates.n = (later.R * n_to - earlier.R * n_from) / span;
  rates.opening = (opens(after, v + way, z, h) - opens(before, v - way, z, h)) / span;
  return rates;
}

LineScale line_scale(const FlankPoint& point, double slope) {
  const double along = (point.x_v * slope + point.x_z).norm();
  return {along, point.x_v.cross(point.x_z).norm() / along};
}

}  // namespace elastogear::contact
