#include "reduction/dense/dense_hermitian.h"

#include <slepcsys.h>

#include <slepcblaslapack.h>

#include <complex>

#include "elastogear/base/error.h"
#include "reduction/dense/residual.h"

// PETSc declares the routines of real numbers alone.
// NOLINTBEGIN(readability-identifier-naming): the names are LAPACK's
extern "C" {
void zhetrf_(const char* triangle, const PetscBLASInt* n, std::complex<double>* A, const PetscBLASInt* stride,
             PetscBLASInt* pivot, std::complex<double>* work, const PetscBLASInt* n_work, PetscBLASInt* info);
void zhetrs2_(const char* triangle, const PetscBLASInt* n, const PetscBLASInt* n_columns,
              const std::complex<double>* A, const PetscBLASInt* stride, const PetscBLASInt* pivot,
              std::complex<double>* B, const PetscBLASInt* B_stride, std::complex<double>* work,
              PetscBLASInt* info);
void zpotrf_(const char* triangle, const PetscBLASInt* n, std::complex<double>* A, const PetscBLASInt* stride,
             PetscBLASInt* info);
void zpotrs_(const char* triangle, const PetscBLASInt* n, const PetscBLASInt* n_columns,
             const std::complex<double>* A, const PetscBLASInt* stride, std::complex<double>* B,
             const PetscBLASInt* B_stride, PetscBLASInt* info);
}
// NOLINTEND(readability-identifier-naming)

namespace elastogear::reduction {
namespace {

static_assert(sizeof(PetscBLASInt) == sizeof(int), "LAPACK must have 32-bit indices");
constexpr PetscBLASInt kPanel = 64;  // columns that are factorised together

// A pivot of two rows has one negative eigenvalue and one positive.
int count_negative(const Eigen::MatrixXcd& factor, const std::vector<int>& pivot) {
  int n_negative = 0;
  for (std::size_t i = 0; i < pivot.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const bool pair = pivot[i] < 0;
    n_negative += pair || factor(at, at).real() < 0;
    i += pair;
  }
  return n_negative;
}

}  // namespace

int factorise_hermitian(Eigen::MatrixXcd& A, std::vector<int>& pivot) {
  const auto n = static_cast<PetscBLASInt>(A.rows()), n_work = kPanel * n;
  PetscBLASInt info = 0;
  pivot.resize(static_cast<std::size_t>(n));
  if (n == 0) return 0;
  Eigen::VectorXcd work(n_work);
  zhetrf_("L", &n, A.data(), &n, pivot.data(), work.data(), &n_work, &info);
  if (info > 0) fail_singular("a pivot is zero");
  require(info == 0, "LAPACK's zhetrf failed with code ", info, " on ", n, " rows");
  return count_negative(A, pivot);
}

void solve_hermitian(const Eigen::MatrixXcd& factor, const std::vector<int>& pivot, Eigen::MatrixXcd& B) {
  const auto n = static_cast<PetscBLASInt>(B.rows()), n_columns = static_cast<PetscBLASInt>(B.cols());
  PetscBLASInt info = 0;
  if (n == 0 || n_columns == 0) return;
  Eigen::VectorXcd work(n);
  zhetrs2_("L", &n, &n_columns, factor.data(), &n, pivot.data(), B.data(), &n, work.data(), &info);
  require(info == 0, "LAPACK's zhetrs2 failed with code ", info, " on ", n, " rows");
}

bool cholesky_hermitian(Eigen::MatrixXcd& A) {
  const auto n = static_cast<PetscBLASInt>(A.rows());
  PetscBLASInt info = 0;
  if (n > 0) zpotrf_("L", &n, A.data(), &n, &info);
  return info == 0;
}

void solve_cholesky(const Eigen::MatrixXcd& L, Eigen::MatrixXcd& B) {
  const auto n = static_cast<PetscBLASInt>(B.rows()), n_columns = static_cast<PetscBLASInt>(B.cols());
  PetscBLASInt info = 0;
  if (n > 0 && n_columns > 0) zpotrs_("L", &n, &n_columns, L.data(), &n, B.data(), &n, &info);
}

}  // namespace elastogear::reduction
