#include "elastogear/evaluation/motion.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "elastogear/base/error.h"

namespace elastogear::evaluation {
namespace {

using std::numbers::pi;

constexpr double kParallel = 0.9;  // cosine between axes: those of worm drives are at right angles

// Angle of a gear about its axis, rad, up to whole turns; the axis may be tilted a little.
double twist(const Gear& gear, std::size_t step) {
  const Eigen::Matrix3d R = gear.R.transpose() * gear.rotation[step];
  return std::atan2(R(1, 0) - R(0, 1), R(0, 0) + R(1, 1));
}

double nearest(double angle, double to) { return to + std::remainder(angle - to, 2 * pi); }

}  // namespace

double pitch(const Gear& gear) { return 2 * pi / gear.toothing.z; }

Eigen::VectorXd angles(const Gear& gear, const Eigen::VectorXd& nominal) {
  Eigen::VectorXd phi(nominal.size());
  for (Eigen::Index i = 0; i < phi.size(); ++i)
    phi[i] = nearest(twist(gear, static_cast<std::size_t>(i)), nominal[i]);
  return phi;
}

Eigen::VectorXd nominal_angles(const Gear& gear, int first_teeth, const Eigen::VectorXd& roll) {
  return gear.angle + (gear.ratio * 2 * pi / first_teeth * roll).array();
}

Eigen::VectorXd continuous_angles(const Gear& gear, int first_teeth, double roll) {
  Eigen::VectorXd phi(static_cast<Eigen::Index>(gear.rotation.size()));
  double last = gear.angle + gear.ratio * 2 * pi / first_teeth * roll;
  for (Eigen::Index i = 0; i < phi.size(); ++i)
    phi[i] = last = nearest(twist(gear, static_cast<std::size_t>(i)), last);
  return phi;
}

Transmission transmission(const Gear& first, const Gear& second, double sense) {
  Transmission t;
  t.ratio = static_cast<double>(first.toothing.z) / second.toothing.z;
  t.s = first.ratio * second.ratio > 0 ? 1 : -1;
  t.sense = first.ratio > 0 ? sense : -sense;
  t.parallel = std::abs(first.R.col(2).dot(second.R.col(2))) > kParallel;
  t.radius = t.parallel && second.toothing.r_b > 0 ? second.toothing.r_b : second.toothing.r;
  return t;
}

Eigen::VectorXd transmission_error(const Transmission& t, const Eigen::VectorXd& phi_1,
                                   const Eigen::VectorXd& phi_2) {
  return t.sense * t.radius * (t.s * phi_2 - t.ratio * phi_1);
}

Eigen::VectorXd stiffness(const Eigen::VectorXd& force, const Eigen::VectorXd& error,
                          const Eigen::VectorXd& other_error) {
  require(force.size() == error.size() && error.size() == other_error.size(), "stiffness of ", force.size(),
          " forces, ", error.size(), " and ", other_error.size(), " transmission errors: must be as many");
  Eigen::VectorXd c(force.size());
  for (Eigen::Index i = 0; i < c.size(); ++i) {
    const double way = std::abs(error[i] - other_error[i]);
    c[i] = way > 0 ? std::abs(force[i]) / way : std::numeric_limits<double>::quiet_NaN();
  }
  return c;
}

Eigen::Vector3d sliding_velocity(const Gear& first, const Gear& second, std::size_t step,
                                 const Eigen::Vector3d& x, const Eigen::Vector3d& n, double omega) {
  const auto velocity = [&](const Gear& gear) -> Eigen::Vector3d {
    return omega * gear.ratio * gear.axis(step).cross(x - gear.position[step]);
  };
  const Eigen::Vector3d v = velocity(first) - velocity(second);
  return v - n.dot(v) * n;
}

double place_of_tooth(const Gear& gear, const Gear& mate, int tooth, std::size_t step) {
  const Eigen::Vector3d to_mate =
      gear.rotation[step].transpose() * (mate.position[step] - gear.position[step]);
  // A planet meets its ring on the side that is away from the ring's axis.
  const double direction = std::atan2(to_mate[1], to_mate[0]) + (mate.toothing.internal ? pi : 0);
  const double off = std::remainder(gear::tooth_angle(gear.toothing, tooth) - direction, 2 * pi);
  return (gear.ratio > 0 ? 1 : -1) * off / pitch(gear);
}

std::optional<std::array<double, 2>> path_of_contact(const Gear& first, const Gear& second, int side) {
  const gear::Toothing &t_1 = first.toothing, &t_2 = second.toothing;
  const Eigen::Vector3d axis = second.axis(0), apart = first.position[0] - second.position[0];
  const double a = (apart - axis.dot(apart) * axis).norm();
  const bool parallel = std::abs(axis.dot(first.axis(0))) > kParallel;
  if (!(t_1.r_b > 0) || !(t_2.r_b > 0) || t_1.internal || t_2.internal || !parallel || side == 0 ||
      !(a > t_1.r_b + t_2.r_b))
    return {};
  const double alpha_w = std::acos((t_1.r_b + t_2.r_b) / a), action = a * std::sin(alpha_w);
  const auto roll = [](const gear::Toothing& t) { return std::sqrt(t.r_start * t.r_start - t.r_b * t.r_b); };
  const double half_overlap =
      std::min(first.width, second.width) / 2 * std::abs(std::tan(t_2.beta_b)) / (t_2.r_b * pitch(second));
  std::array<double, 2> place;
  for (int end : {0, 1}) {
    const double rho = end == 0 ? roll(t_2) : action - roll(t_1);
    place[static_cast<std::size_t>(end)] =
        (second.ratio > 0 ? 1 : -1) * side * (rho / t_2.r_b - alpha_w - t_2.psi_b) / pitch(second);
  }
  if (place[0] > place[1]) std::swap(place[0], place[1]);
  return std::array{place[0] - half_overlap, place[1] + half_overlap};
}

}  // namespace elastogear::evaluation
