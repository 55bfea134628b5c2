#include "drive/formed_flanks.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "elastogear/gear/flank.h"

namespace elastogear::drive {

using Eigen::Vector2d;
using Eigen::Vector3d;

// The foot of the perpendicular, by steps in the tangent plane: each leaves the error times the distance over
// the radius of curvature. Farther off than loads can close the distance is that of first order.
contact::FlankDistance FormedFlanks::distance(const contact::FlankName& flank, const Vector3d& x) const {
  constexpr int kMostSteps = 30;
  constexpr double kFound = 1e-14, kFar = 0.2;  // of the height of a flank
  const double height = extent_.upper - extent_.lower;
  const double estimate = gear::flank_distance(t_, flank.tooth, flank.side, x);
  const Vector2d start = chart(flank, x);
  const contact::FlankPoint beside = point(flank, start[0], start[1]);
  const contact::FlankDistance far{estimate, beside.n, start[0]};
  if (std::abs(estimate) > kFar * height) return far;
  contact::FlankPoint foot = beside;
  Vector2d at = start;
  for (int step = 0; step < kMostSteps; ++step) {
    Eigen::Matrix<double, 3, 2> T;
    T << foot.x_v, foot.x_z;
    const Vector2d d = (T.transpose() * T).inverse() * (T.transpose() * (x - foot.x));
    at += d;
    foot = point(flank, at[0], at[1]);
    if ((foot.x - beside.x).norm() > height) return far;
    if ((T * d).norm() <= kFound * height) break;
  }
  return {(x - foot.x).dot(foot.n), foot.n, at[0]};
}

double FormedFlanks::deviation(const contact::FlankName& flank, double v, double z) const {
  if (!deviations_) return 0;
  return gear::flank_deviation(t_, *deviations_, {flank.tooth, flank.side}, point(flank, v, z).x);
}

contact::FlankName FormedFlanks::flank_of(const std::string& group) const {
  const auto flank = gear::flank_of(t_, group);
  return flank ? contact::FlankName{flank->tooth, flank->side} : contact::FlankName{-1, 0};
}

contact::FlankPoint FormedFlanks::with_normal(const Vector3d& x, const Vector3d& x_v, const Vector3d& x_z,
                                              int side) {
  return {x, -side * x_v.cross(x_z).normalized(), x_v, x_z};
}

}  // namespace elastogear::drive
