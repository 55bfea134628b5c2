#include "elastogear/dynamics/dense_lu.h"

#include <petscblaslapack.h>

#include "elastogear/base/error.h"

namespace elastogear::dynamics {

void DenseLu::set(Eigen::MatrixXd A) {
  factors_ = std::move(A);
  auto n = static_cast<PetscBLASInt>(factors_.rows());
  PetscBLASInt info = 0;
  pivot_.resize(n);
  if (n > 0) LAPACKgetrf_(&n, &n, factors_.data(), &n, pivot_.data(), &info);
  require(info == 0, "the effective matrix is singular");
}

Eigen::VectorXd DenseLu::solve(Eigen::VectorXd y) const {
  auto n = static_cast<PetscBLASInt>(y.size());
  PetscBLASInt one = 1, info = 0;
  if (n > 0) LAPACKgetrs_("N", &n, &one, factors_.data(), &n, pivot_.data(), y.data(), &n, &info);
  return y;
}

void add_product(const Eigen::MatrixXd& A, const Eigen::VectorXd& x, Eigen::VectorXd& y) {
  const auto m = static_cast<PetscBLASInt>(A.rows()), n = static_cast<PetscBLASInt>(A.cols());
  const PetscBLASInt one = 1;
  const double factor = 1;
  if (m > 0 && n > 0) BLASgemv_("N", &m, &n, &factor, A.data(), &m, x.data(), &one, &factor, y.data(), &one);
}

}  // namespace elastogear::dynamics
