#pragma once
// LU factors of a dense matrix by LAPACK: for hundreds of rows several times faster than Eigen's, which is
// compiled for processors without wide registers.

#include <petscsys.h>

#include <Eigen/Core>
#include <vector>

namespace elastogear::dynamics {

class DenseLu {
 public:
  /// A: square, finite. Throws Error when a pivot is zero.
  void set(Eigen::MatrixXd A);
  /// A^-1 y; an empty y needs no set().
  Eigen::VectorXd solve(Eigen::VectorXd y) const;

 private:
  Eigen::MatrixXd factors_;
  std::vector<PetscBLASInt> pivot_;
};

}  // namespace elastogear::dynamics
