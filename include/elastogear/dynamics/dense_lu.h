#pragma once
// LU factors and products of dense matrices by LAPACK and BLAS: for hundreds of rows several times faster
// than Eigen's, which are compiled for processors without wide registers.

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

/// y += factor A x
void add_product(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::VectorXd& x, Eigen::VectorXd& y,
                 double factor = 1);
/// y += A x of a symmetric A, whose lower triangle is read: half the bytes. x fills the first entries of y.
void add_symmetric_product(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::VectorXd& x,
                           Eigen::VectorXd& y);
/// A' x
Eigen::VectorXd project(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::VectorXd& x);

}  // namespace elastogear::dynamics
