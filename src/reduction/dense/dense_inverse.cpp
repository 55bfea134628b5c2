#include "reduction/dense/dense_inverse.h"

#include <slepcsys.h>

#include <slepcblaslapack.h>

#include <cmath>
#include <vector>

// PETSc declares few of LAPACK's routines.
// NOLINTBEGIN(readability-identifier-naming): the names are LAPACK's
extern "C" {
void dpocon_(const char* triangle, const PetscBLASInt* n, const double* A, const PetscBLASInt* stride,
             const double* norm, double* condition, double* work, PetscBLASInt* integer, PetscBLASInt* info);
void dpotri_(const char* triangle, const PetscBLASInt* n, double* A, const PetscBLASInt* stride,
             PetscBLASInt* info);
void dsycon_(const char* triangle, const PetscBLASInt* n, const double* A, const PetscBLASInt* stride,
             const PetscBLASInt* pivot, const double* norm, double* condition, double* work,
             PetscBLASInt* integer, PetscBLASInt* info);
void dsytri2_(const char* triangle, const PetscBLASInt* n, double* A, const PetscBLASInt* stride,
              const PetscBLASInt* pivot, double* work, const PetscBLASInt* n_work, PetscBLASInt* info);
}
// NOLINTEND(readability-identifier-naming)

namespace elastogear::reduction {
namespace {

using Eigen::MatrixXd;

constexpr PetscBLASInt kInversePanel = 64;  // columns that are worked on together

PetscBLASInt rows(const MatrixXd& A) { return static_cast<PetscBLASInt>(A.rows()); }

// Largest sum of a column's moduli.
double norm_of(const MatrixXd& A) {
  return A.selfadjointView<Eigen::Lower>().toDenseMatrix().cwiseAbs().colwise().sum().maxCoeff();
}

// By Cholesky's factor; false where there is none.
bool invert_definite(MatrixXd& A, double norm, Inverted& result) {
  const PetscBLASInt n = rows(A);
  PetscBLASInt info = 0;
  LAPACKpotrf_("L", &n, A.data(), &n, &info);
  if (info != 0) return false;
  std::vector<double> work(3 * static_cast<std::size_t>(n));
  std::vector<PetscBLASInt> integer(static_cast<std::size_t>(n));
  dpocon_("L", &n, A.data(), &n, &norm, &result.condition, work.data(), integer.data(), &info);
  dpotri_("L", &n, A.data(), &n, &info);
  return info == 0;
}

// A pivot of two rows has one negative eigenvalue and one positive.
int count_negative(const MatrixXd& factor, const std::vector<PetscBLASInt>& pivot) {
  int n_negative = 0;
  for (std::size_t i = 0; i < pivot.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const bool pair = pivot[i] < 0;
    n_negative += pair || factor(at, at) < 0;
    i += pair;
  }
  return n_negative;
}

// By L D L' (Bunch and Kaufman).
void invert_indefinite(MatrixXd& A, double norm, Inverted& result) {
  const PetscBLASInt n = rows(A), n_work = (n + kInversePanel + 1) * (kInversePanel + 3);
  PetscBLASInt info = 0;
  std::vector<PetscBLASInt> pivot(static_cast<std::size_t>(n)), integer(pivot.size());
  std::vector<double> work(static_cast<std::size_t>(n_work));
  result.condition = 0;
  LAPACKsytrf_("L", &n, A.data(), &n, pivot.data(), work.data(), &n_work, &info);
  if (info != 0) return;
  result.n_negative = count_negative(A, pivot);
  dsycon_("L", &n, A.data(), &n, pivot.data(), &norm, &result.condition, work.data(), integer.data(), &info);
  dsytri2_("L", &n, A.data(), &n, pivot.data(), work.data(), &n_work, &info);
  if (info != 0) result.condition = 0;
}

}  // namespace

Inverted invert_symmetric(MatrixXd& A) {
  Inverted result;
  if (A.size() == 0) return result;
  const double norm = norm_of(A);
  A.triangularView<Eigen::StrictlyUpper>() = A.transpose();  // keeps what Cholesky's factor overwrites
  const Eigen::VectorXd diagonal = A.diagonal();
  if (!invert_definite(A, norm, result)) {
    A.triangularView<Eigen::StrictlyLower>() = A.transpose();
    A.diagonal() = diagonal;
    invert_indefinite(A, norm, result);
  }
  A.triangularView<Eigen::StrictlyUpper>() = A.transpose();
  return result;
}

}  // namespace elastogear::reduction
