#include "reduction/dense/dense_blas.h"

#include <petscsys.h>
#include <slepcblaslapack.h>

#include <algorithm>

namespace elastogear::reduction {
namespace {

PetscBLASInt blas_int(Eigen::Index n) { return static_cast<PetscBLASInt>(n); }

template <class Columns>
PetscBLASInt stride(const Columns& A) {
  return blas_int(std::max<Eigen::Index>(1, A.outerStride()));
}

}  // namespace

bool cholesky(DenseColumns A) {
  const PetscBLASInt n = blas_int(A.rows()), a = stride(A);
  PetscBLASInt info = 0;
  if (n > 0) LAPACKpotrf_("L", &n, A.data(), &a, &info);
  return info == 0;
}

void solve_lower(const ConstDenseColumns& L, DenseColumns B) {
  const PetscBLASInt m = blas_int(B.rows()), n = blas_int(B.cols()), l = stride(L), b = stride(B);
  const double one = 1;
  if (m > 0 && n > 0) BLAStrsm_("L", "L", "N", "N", &m, &n, &one, L.data(), &l, B.data(), &b);
}

void solve_lower_transposed_right(const ConstDenseColumns& L, DenseColumns B) {
  const PetscBLASInt m = blas_int(B.rows()), n = blas_int(B.cols()), l = stride(L), b = stride(B);
  const double one = 1;
  if (m > 0 && n > 0) BLAStrsm_("R", "L", "T", "N", &m, &n, &one, L.data(), &l, B.data(), &b);
}

}  // namespace elastogear::reduction
