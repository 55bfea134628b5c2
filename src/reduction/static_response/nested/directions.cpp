#include "reduction/static_response/nested/directions.h"

#include <petscsys.h>
#include <slepcblaslapack.h>

#include <algorithm>
#include <vector>

#include "elastogear/base/error.h"

// PETSc does not declare it.
// NOLINTNEXTLINE(readability-identifier-naming): the name is LAPACK's
extern "C" void dpstrf_(const char* triangle, const PetscBLASInt* n, double* A, const PetscBLASInt* stride,
                        PetscBLASInt* pivot, PetscBLASInt* rank, const double* tolerance, double* work,
                        PetscBLASInt* info);

namespace elastogear::reduction {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

// The lower triangle of A becomes L of A(pivot, pivot) = L L', columns after its rank 0.
std::vector<PetscBLASInt> pivoted_cholesky(MatrixXd& A) {
  const auto n = static_cast<PetscBLASInt>(A.rows());
  std::vector<PetscBLASInt> pivot(static_cast<std::size_t>(n));
  std::vector<double> work(2 * static_cast<std::size_t>(n));
  PetscBLASInt rank = 0, info = 0;
  const double roundoff = -1;
  dpstrf_("L", &n, A.data(), &n, pivot.data(), &rank, &roundoff, work.data(), &info);
  require(info >= 0, "LAPACK's dpstrf failed with code ", info, " on ", n, " rows");
  A.rightCols(n - rank).setZero();
  A.triangularView<Eigen::StrictlyUpper>().setZero();
  return pivot;
}

// A becomes Q of A = Q R.
void orthogonalise(MatrixXd& A) {
  constexpr PetscBLASInt kBlock = 64;
  const auto n = static_cast<PetscBLASInt>(A.rows());
  const PetscBLASInt n_work = kBlock * n;
  std::vector<double> tau(static_cast<std::size_t>(n)), work(static_cast<std::size_t>(n_work));
  PetscBLASInt info = 0;
  LAPACKgeqrf_(&n, &n, A.data(), &n, tau.data(), work.data(), &n_work, &info);
  require(info == 0, "LAPACK's dgeqrf failed with code ", info, " on ", n, " rows");
  LAPACKorgqr_(&n, &n, &n, A.data(), &n, tau.data(), work.data(), &n_work, &info);
  require(info == 0, "LAPACK's dorgqr failed with code ", info, " on ", n, " rows");
}

}  // namespace

// With A(:, pivot) = Q L' and L = V_p R: A(:, pivot) V_p = Q R'.
MatrixXd directions(MatrixXd gram) {
  if (gram.size() == 0) return gram;
  const std::vector<PetscBLASInt> pivot = pivoted_cholesky(gram);
  orthogonalise(gram);
  MatrixXd V(gram.rows(), gram.cols());
  for (Index j = 0; j < V.cols(); ++j)
    for (Index i = 0; i < V.rows(); ++i)
      V(pivot[static_cast<std::size_t>(i)] - 1, V.cols() - 1 - j) = gram(i, j);
  return V;
}

}  // namespace elastogear::reduction
