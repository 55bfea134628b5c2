#pragma once
// The forces of stations that may press and not pull: a convex problem, whose solution is a function of the
// gaps alone (docs/theory, section 6.18).

#include <Eigen/Core>
#include <vector>

#include "elastogear/contact/station_law.h"

namespace elastogear::contact {

/// n stations. Eq. (6.38).
struct StationProblem {
  Eigen::MatrixXd C;            ///< n x n, m/N, symmetric: displacements but for what `own` adds
  std::vector<StationLaw> own;  ///< n
  Eigen::VectorXd gap;          ///< n, m, of the bodies without forces, < 0 where they would overlap
};

struct StationForces {
  Eigen::VectorXd f;          ///< n, N, >= 0
  double potential = 0;       ///< J, the least value of Eq. (6.38); its derivative with respect to gaps is f
  std::vector<int> active;    ///< stations with f > 0, ascending
  Eigen::MatrixXd stiffness;  ///< N/m, among these, symmetric, positive definite: -df/dgap. Eq. (6.48)
  int iterations = 0;
};

/// J: of any forces >= 0. Eq. (6.38).
double potential(const StationProblem& problem, const Eigen::VectorXd& f);
/// m: gaps under any forces >= 0, the gradient of the potential. Eq. (6.38).
Eigen::VectorXd loaded_gaps(const StationProblem& problem, const Eigen::VectorXd& f);
/// The forces with the least potential, without a start value. Eq. (6.47). Throws Error where the potential
/// is not convex, as by wrong static responses.
StationForces station_forces(const StationProblem& problem);

}  // namespace elastogear::contact
