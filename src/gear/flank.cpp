#include "elastogear/gear/flank.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

#include "gear/flank_place.h"

namespace elastogear::gear {
namespace {

constexpr double kRoundoff = 1e-14;  // of the distance from the axis
constexpr double kSolved = 1e-12;    // the same, of flanks that are found by iterations themselves
constexpr double kLeastCosine = 0.5;
constexpr int kNewtonSteps = 20;
constexpr double kCurvatureStep = 1e-3;  // of the tooth's height

// half: at x, which is r away from the axis.
Eigen::Vector3d normal_at(const Toothing& t, const Flank& flank, const Eigen::Vector3d& x, double r,
                          const HalfAngle& half) {
  const Eigen::Vector3d radial(x[0] / r, x[1] / r, 0), around(-radial[1], radial[0], 0);
  const double d_z = 1 / t.p + half.d_z;
  return (flank.side * (around / r - d_z * Eigen::Vector3d::UnitZ()) - half.d_r * radial).normalized();
}

}  // namespace

std::optional<Flank> flank_of(const std::string& face_set) {
  const auto first = face_set.find('_'), last = face_set.rfind('_');
  if (first == std::string::npos || first == last) return {};
  const std::string_view all = face_set, body = all.substr(0, first), side = all.substr(last + 1),
                         number = all.substr(first + 1, last - first - 1);
  if ((body != "tooth" && body != "thread") || (side != "left" && side != "right")) return {};
  int tooth = 0;
  const auto [end, error] = std::from_chars(number.begin(), number.end(), tooth);
  if (error != std::errc() || end != number.end() || tooth < 1) return {};
  return Flank{tooth - 1, side == "left" ? 1 : -1};
}

std::optional<Flank> flank_of(const Toothing& toothing, const std::string& group) {
  const bool only = toothing.z == 1 && (group == "left" || group == "right");
  return flank_of(only ? "thread_1_" + group : group);
}

Flank nearest_flank(const Toothing& t, const Eigen::Vector3d& x) {
  const double turned = std::atan2(x[1], x[0]) - x[2] / t.p - t.theta_1;
  const double teeth = turned * t.z / (2 * std::numbers::pi), nearest = std::round(teeth);
  const int tooth = static_cast<int>(nearest) % t.z;
  return {tooth < 0 ? tooth + t.z : tooth, teeth >= nearest ? 1 : -1};
}

Eigen::Vector3d flank_normal(const Toothing& t, const Flank& flank, const Eigen::Vector3d& x) {
  const double r = std::hypot(x[0], x[1]);
  return normal_at(t, flank, x, r, half_angle(t, r, flank.side * x[2]));
}

Eigen::Matrix3d flank_curvature(const Toothing& t, const Flank& flank, const Eigen::Vector3d& x) {
  const double step = kCurvatureStep * std::abs(t.r_a - t.r_f);
  const Eigen::Vector3d n = flank_normal(t, flank, x), across = n.unitOrthogonal();
  Eigen::Matrix3d S = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& along : {across, Eigen::Vector3d(n.cross(across))})
    S += (flank_normal(t, flank, x + step * along) - flank_normal(t, flank, x - step * along)) / (2 * step) *
         along.transpose();
  const Eigen::Matrix3d tangential = Eigen::Matrix3d::Identity() - n * n.transpose();
  return tangential * (S + S.transpose()) / 2 * tangential;
}

double flank_distance_along(const Toothing& t, const Flank& flank, const Eigen::Vector3d& x,
                            const Eigen::Vector3d& n) {
  const double close = (t.half_angle ? kSolved : kRoundoff) * std::max(t.r_a, t.r_f);
  double s = 0;
  for (int step = 0; step < kNewtonSteps; ++step) {
    const Eigen::Vector3d at = x + s * n;
    const FlankPlace place = flank_place(t, flank.tooth, flank.side, at);
    if (std::abs(place.distance) <= close) return s;
    const double cosine = n.dot(normal_at(t, flank, at, place.r, place.half));
    if (!(cosine >= kLeastCosine)) break;
    s -= place.distance / cosine;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace elastogear::gear
