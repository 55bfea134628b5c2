#pragma once
// Sliding, friction and efficiency of two gears (docs/theory, section 10.4).

#include <Eigen/Core>

#include "elastogear/evaluation/contact.h"

namespace elastogear::evaluation {

/// One for each time; powers and speeds are those where the drive's first gear turns at omega.
struct Losses {
  double omega = 1;                    ///< rad/s, in the sense in which it drives
  Eigen::VectorXd sliding_speed;       ///< m/s, largest
  Eigen::VectorXd pv;                  ///< W/m^2, largest product of pressure and sliding speed
  Eigen::VectorXd friction;            ///< W, taken by friction, Eq. (10.9)
  Eigen::VectorXd per_friction;        ///< W, sum of normal force times sliding speed
  Eigen::VectorXd input, output;       ///< W, of contact on both gears
  Eigen::VectorXd torque_1, torque_2;  ///< N m, of contact on the gears about their axes
};

/// force (N), torque (N m, about the world origin): 3 x n_t, on the second gear, world frame.
Losses losses(const std::array<const Gear*, 2>& gear, const ContactHistory& contacts,
              const Eigen::Matrix3Xd& force, const Eigen::Matrix3Xd& torque, double omega);

/// Output over input of work, Eq. (10.10), from the gear that bears the larger power to the other; NaN
/// without power.
double efficiency(const Losses& losses);
/// Share of the input that friction takes; NaN without power.
double friction_loss(const Losses& losses);
/// Loss over input per coefficient of friction where forces stay those of this run; NaN without power.
double loss_factor(const Losses& losses);

}  // namespace elastogear::evaluation
