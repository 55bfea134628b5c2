#include "gear/cylindrical/tip_path.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace elastogear::gear {
namespace {

using Eigen::Vector2d;

constexpr int kSteps = 400;          // of a pitch
constexpr int kFilletPoints = 2000;  // chords then miss the fillet by less than 1e-7 modules

// rad, of the tooth of `own` at radius r.
double half_width(const TipPath& path, double r) {
  const double sign = path.own.sign();
  if (sign * (r - path.own.r_form) >= 0) return psi(path.own, r);
  const auto above = std::upper_bound(path.fillet.begin(), path.fillet.end(), sign * r,
                                      [](double radius, const Vector2d& point) { return radius < point[0]; });
  if (above == path.fillet.begin() || above == path.fillet.end()) return psi(path.own, path.own.r_form);
  const Vector2d &low = above[-1], &high = above[0];
  return std::lerp(low[1], high[1], (sign * r - low[0]) / (high[0] - low[0]));
}

// m along the line of action to either side, within which the corner at r_a meets spaces of `own`. The tips
// of an internal pair meet wherever the corner has passed the mate's tip circle; a pitch more, for where it
// starts from.
double reach(const TipPath& path, double r_a) {
  const double pitch = 2 * M_PI * path.own.r_b / path.own.z;
  if (pair_sign(path.own, path.mate) > 0) return pitch;
  const double cosine =
      (std::pow(path.own.r_a, 2) - path.a * path.a - r_a * r_a) / (2 * path.mate.sign() * path.a * r_a);
  return 2 * path.mate.r_b * std::acos(std::clamp(cosine, -1.0, 1.0)) + pitch;
}

}  // namespace

double along_action(const Toothing& t, double r) { return std::sqrt(std::max(0.0, r * r - t.r_b * t.r_b)); }

double along_own(const Toothing& own, const Toothing& mate, double action, double xi) {
  return own.sign() * (pair_sign(own, mate) * action - mate.sign() * xi);
}

TipPath tip_path(const Profile& profile, const Toothing& own, const Toothing& mate, double a, double alpha_wt,
                 double j) {
  TipPath path{.fillet = {}, .own = own, .mate = mate, .a = a, .alpha_wt = alpha_wt, .j = j};
  for (int i = 0; i <= kFilletPoints; ++i) {
    const Vector2d x = profile.fillet(static_cast<double>(i) / kFilletPoints);
    const double radius = own.sign() * x.norm();
    if (path.fillet.empty() || radius > path.fillet.back()[0])
      path.fillet.emplace_back(radius, profile.lateral(x));
  }
  return path;
}

// `own` turns about the origin, the mate about a point of the x axis, and the pitch point lies at x > 0. The
// line of action leaves own's base circle at the angle -alpha_wt and goes along u; s counts along it. A tooth
// of `own` whose flank (left, of internal gears right) is at s stands at the angle -alpha_wt + s/r_b - psi_b
// (internal: + psi_b). The flank behind it is nearer to the other corner by the backlash.
bool tip_keeps_off(const TipPath& path, double r_a, double least) {
  const Toothing &own = path.own, &mate = path.mate;
  const double sign = own.sign(), both = pair_sign(own, mate);
  const Vector2d from = own.r_b * Vector2d(std::cos(path.alpha_wt), -std::sin(path.alpha_wt));
  const Vector2d u(std::sin(path.alpha_wt), std::cos(path.alpha_wt)), centre(mate.sign() * path.a, 0);
  const double begin = along_own(own, mate, path.a * std::sin(path.alpha_wt), along_action(mate, r_a));
  const Vector2d corner = from + begin * u - centre;
  const double step = 2 * M_PI * own.r_b / own.z / kSteps;
  const int n = static_cast<int>(std::ceil(reach(path, r_a) / step));
  for (int i = -n; i <= n; ++i) {
    const double rolled = step * i;
    const Vector2d x = centre + Eigen::Rotation2Dd(-both * rolled / mate.r_b) * corner;
    const double r = x.norm();
    if (sign * (r - own.r_a) > 0 || sign * (r - own.r_f) < 0) continue;
    const double tooth = -path.alpha_wt + (begin + rolled) / own.r_b - sign * own.psi_b;
    const double angle = sign * std::remainder(std::atan2(x[1], x[0]) - tooth, 2 * M_PI / own.z);
    const double behind = angle < 0 ? path.j / own.r_b : 0;
    if (r * (std::abs(angle) - half_width(path, r) - behind) < least) return false;
  }
  return true;
}

}  // namespace elastogear::gear
