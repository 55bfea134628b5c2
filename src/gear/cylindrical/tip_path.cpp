#include "gear/cylindrical/tip_path.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace elastogear::gear {
namespace {

using Eigen::Vector2d;

constexpr int kSteps = 400;          // of the way
constexpr int kFilletPoints = 2000;  // chords then miss the fillet by less than 1e-7 modules

// rad, of the tooth of `own` at radius r.
double half_width(const TipPath& path, double r) {
  if (r >= path.own.r_form) return psi(path.own, r);
  const auto above = std::upper_bound(path.fillet.begin(), path.fillet.end(), r,
                                      [](double radius, const Vector2d& point) { return radius < point[0]; });
  if (above == path.fillet.begin() || above == path.fillet.end()) return psi(path.own, path.own.r_form);
  const Vector2d &low = above[-1], &high = above[0];
  return std::lerp(low[1], high[1], (r - low[0]) / (high[0] - low[0]));
}

}  // namespace

double along_action(const Toothing& t, double r) { return std::sqrt(std::max(0.0, r * r - t.r_b * t.r_b)); }

TipPath tip_path(const Profile& profile, const Toothing& own, const Toothing& mate, double a,
                 double alpha_wt) {
  TipPath path{.fillet = {}, .own = own, .mate = mate, .a = a, .alpha_wt = alpha_wt};
  for (int i = 0; i <= kFilletPoints; ++i) {
    const Vector2d x = profile.fillet(static_cast<double>(i) / kFilletPoints);
    if (path.fillet.empty() || x.norm() > path.fillet.back()[0])
      path.fillet.emplace_back(x.norm(), profile.lateral(x));
  }
  return path;
}

// `own` turns about the origin, the mate about (a, 0). The line of action leaves own's base circle at the
// angle -alpha_wt and goes along u; s counts along it. The tooth of `own` whose left flank is at s stands at
// the angle -alpha_wt + s/r_b - psi_b, and the mate turns against it.
double tip_gap(const TipPath& path, double r_a) {
  const Vector2d from = path.own.r_b * Vector2d(std::cos(path.alpha_wt), -std::sin(path.alpha_wt));
  const Vector2d u(std::sin(path.alpha_wt), std::cos(path.alpha_wt)), centre(path.a, 0);
  const double begin = path.a * std::sin(path.alpha_wt) - along_action(path.mate, r_a);
  const Vector2d corner = from + begin * u - centre;
  const double pitch = 2 * M_PI * path.own.r_b / path.own.z;
  double least = std::numeric_limits<double>::infinity();
  for (int i = -kSteps; i <= kSteps; ++i) {
    const double rolled = pitch * i / kSteps;
    const Vector2d x = centre + Eigen::Rotation2Dd(-rolled / path.mate.r_b) * corner;
    const double r = x.norm();
    if (r > path.own.r_a || r < path.own.r_f) continue;
    const double tooth = -path.alpha_wt + (begin + rolled) / path.own.r_b - path.own.psi_b;
    const double angle = std::remainder(std::atan2(x[1], x[0]) - tooth, 2 * M_PI);
    least = std::min(least, r * (angle - half_width(path, r)));
  }
  return least;
}

}  // namespace elastogear::gear
