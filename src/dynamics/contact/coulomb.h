#pragma once
// Contact forces with Coulomb friction at unchanged closest points.

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace elastogear::dynamics {

/// One contact's entries of z and y: its normal force p and gap, and where it sticks the two tangential
/// forces t and displacements behind them.
struct CoulombContact {
  Eigen::Index first = 0;
  bool sticks = false;
  double mu = 0;  ///< -, of the limit |t| <= mu p
};

/// z with y = q + C z and, for each contact, 0 <= p, 0 <= y_n, p y_n = 0 and |t| <= mu p, where y_t = 0 or
/// t = -mu p y_t / |y_t|: by a semismooth Newton method on the projections of P. Alart and A. Curnier
/// (Comput. Methods Appl. Mech. Engrg. 92, 1991, 353-375), or where it does not converge by relaxation,
/// contact by contact. z: a first guess. Nothing where neither ends.
std::optional<Eigen::VectorXd> solve_coulomb(const Eigen::MatrixXd& C, const Eigen::VectorXd& q,
                                             const std::vector<CoulombContact>& contacts, Eigen::VectorXd z);

/// Is the tangential force of this contact at its limit?
bool slides(const CoulombContact& contact, const Eigen::VectorXd& z);

}  // namespace elastogear::dynamics
