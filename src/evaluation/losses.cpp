#include "evaluation/losses.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

namespace elastogear::evaluation {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

double moment(const Gear& gear, std::size_t step, const Eigen::Vector3d& force,
              const Eigen::Vector3d& torque) {
  return gear.axis(step).dot(torque - gear.position[step].cross(force));
}

// Power that goes in, W: the first gear's, or the second one's where it drives.
double mean_input(const Losses& losses) { return std::max(losses.input.mean(), -losses.output.mean()); }

}  // namespace

Losses losses(const std::array<const Gear*, 2>& gear, const ContactHistory& contacts,
              const Eigen::Matrix3Xd& force, const Eigen::Matrix3Xd& torque, double omega) {
  const auto n = static_cast<Eigen::Index>(contacts.size());
  Losses losses;
  losses.omega = omega;
  for (Eigen::VectorXd* values : {&losses.sliding_speed, &losses.pv, &losses.friction, &losses.per_friction,
                                  &losses.input, &losses.output, &losses.torque_1, &losses.torque_2})
    *values = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto step = static_cast<std::size_t>(i);
    for (const FlankContact& c : contacts[step]) {
      const Eigen::Vector3d v = sliding_velocity(*gear[0], *gear[1], step, c.x_W, c.n, omega);
      losses.sliding_speed[i] = std::max(losses.sliding_speed[i], v.norm());
      losses.pv[i] = std::max(losses.pv[i], c.pressure * v.norm());
      losses.friction[i] += c.f.dot(v);
      losses.per_friction[i] += c.normal_force * v.norm();
    }
    losses.torque_1[i] = -moment(*gear[0], step, force.col(i), torque.col(i));
    losses.torque_2[i] = moment(*gear[1], step, force.col(i), torque.col(i));
  }
  losses.input = -omega * gear[0]->ratio * losses.torque_1;
  losses.output = omega * gear[1]->ratio * losses.torque_2;
  return losses;
}

double efficiency(const Losses& losses) {
  const double input = losses.input.mean(), output = losses.output.mean();
  if (input > 0 && output > 0) return output / input;
  return input < 0 && output < 0 ? input / output : kNone;
}

double friction_loss(const Losses& losses) {
  const double input = mean_input(losses);
  return input > 0 ? losses.friction.mean() / input : kNone;
}

double loss_factor(const Losses& losses) {
  const double input = mean_input(losses);
  return input > 0 ? losses.per_friction.mean() / input : kNone;
}

}  // namespace elastogear::evaluation
