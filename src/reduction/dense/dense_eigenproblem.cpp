#include "reduction/dense/dense_eigenproblem.h"

#include <slepcsys.h>

#include <slepcblaslapack.h>

#include <vector>

#include "elastogear/base/error.h"

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

}  // namespace elastogear::reduction
