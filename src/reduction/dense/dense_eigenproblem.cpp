#include "reduction/dense/dense_eigenproblem.h"

#include <slepcsys.h>

#include <slepcblaslapack.h>

#include <complex>
#include <vector>

#include "elastogear/base/error.h"

// PETSc declares the routines of real numbers alone.
// NOLINTNEXTLINE(readability-identifier-naming): the name is LAPACK's
extern "C" void zheevd_(const char* job, const char* triangle, const PetscBLASInt* n, std::complex<double>* A,
                        const PetscBLASInt* stride, double* eigenvalue, std::complex<double>* work,
                        const PetscBLASInt* n_work, double* real, const PetscBLASInt* n_real,
                        PetscBLASInt* integer, const PetscBLASInt* n_integer, PetscBLASInt* info);

namespace elastogear::reduction {

Eigen::VectorXd diagonalise(Eigen::MatrixXd& A) {
  auto n = static_cast<PetscBLASInt>(A.rows());
  Eigen::VectorXd eigenvalue(n);
  PetscBLASInt n_work = 1 + 6 * n + 2 * n * n, n_integer = 3 + 5 * n, info = 0;
  std::vector<double> work(n_work);
  std::vector<PetscBLASInt> integer(n_integer);
  LAPACKsyevd_("V", "U", &n, A.data(), &n, eigenvalue.data(), work.data(), &n_work, integer.data(),
               &n_integer, &info);
  require(info == 0, "LAPACK's dsyevd failed with code ", info, " on ", n, " rows");
  return eigenvalue;
}

Eigen::VectorXd diagonalise(Eigen::MatrixXcd& A) {
  auto n = static_cast<PetscBLASInt>(A.rows());
  Eigen::VectorXd eigenvalue(n);
  PetscBLASInt n_work = 1 + n * (n + 2), n_real = 1 + 5 * n + 2 * n * n, n_integer = 3 + 5 * n, info = 0;
  std::vector<std::complex<double>> work(n_work);
  std::vector<double> real(n_real);
  std::vector<PetscBLASInt> integer(n_integer);
  zheevd_("V", "U", &n, A.data(), &n, eigenvalue.data(), work.data(), &n_work, real.data(), &n_real,
          integer.data(), &n_integer, &info);
  require(info == 0, "LAPACK's zheevd failed with code ", info, " on ", n, " rows");
  return eigenvalue;
}

}  // namespace elastogear::reduction
