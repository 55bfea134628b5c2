#include "gear/cylindrical/tip_path.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace elastogear::gear {
namespace {

using Eigen::Vector2d;

constexpr int kSteps = 400;      // of the way
constexpr int kBisections = 50;  // for the point of a fillet at a radius

// rad, of the tooth of `own` at radius r.
double half_width(const Profile& root, double r) {
  if (r >= root.r_form) return root.half_width(r);
  double low = 0, high = 1;
  for (int i = 0; i < kBisections; ++i) {
    const double t = (low + high) / 2;
    (root.fillet(t).norm() < r ? low : high) = t;
  }
  return root.lateral(root.fillet(high));
}

}  // namespace

double along_action(const Toothing& t, double r) { return std::sqrt(std::max(0.0, r * r - t.r_b * t.r_b)); }

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
    least = std::min(least, r * (angle - half_width(path.root, r)));
  }
  return least;
}

}  // namespace elastogear::gear
