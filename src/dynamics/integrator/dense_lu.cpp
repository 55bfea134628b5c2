#include "elastogear/dynamics/dense_lu.h"

#include <petscblaslapack.h>

#include "elastogear/base/error.h"

// PETSc does not declare this one.
// NOLINTNEXTLINE(readability-identifier-naming): the name is BLAS's
extern "C" void dsymv_(const char* triangle, const PetscBLASInt* n, const double* alpha, const double* A,
                       const PetscBLASInt* a, const double* x, const PetscBLASInt* x_step, const double* beta,
                       double* y, const PetscBLASInt* y_step);

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

namespace {

// y += factor op(A) x
void add_product(const char* op, double factor, const Eigen::Ref<const Eigen::MatrixXd>& A,
                 const Eigen::VectorXd& x, Eigen::VectorXd& y) {
  const auto m = static_cast<PetscBLASInt>(A.rows()), n = static_cast<PetscBLASInt>(A.cols()),
             stride = static_cast<PetscBLASInt>(A.outerStride());
  const PetscBLASInt one = 1;
  const double keep = 1;
  if (m > 0 && n > 0)
    BLASgemv_(op, &m, &n, &factor, A.data(), &stride, x.data(), &one, &keep, y.data(), &one);
}

}  // namespace

void add_product(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::VectorXd& x, Eigen::VectorXd& y,
                 double factor) {
  add_product("N", factor, A, x, y);
}

void add_symmetric_product(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::VectorXd& x,
                           Eigen::VectorXd& y) {
  const auto n = static_cast<PetscBLASInt>(A.cols()), stride = static_cast<PetscBLASInt>(A.outerStride());
  const PetscBLASInt one = 1;
  const double factor = 1;
  if (n > 0) dsymv_("L", &n, &factor, A.data(), &stride, x.data(), &one, &factor, y.data(), &one);
}

Eigen::VectorXd project(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::VectorXd& x) {
  Eigen::VectorXd y = Eigen::VectorXd::Zero(A.cols());
  add_product("T", 1, A, x, y);
  return y;
}

}  // namespace elastogear::dynamics
