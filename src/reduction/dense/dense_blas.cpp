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

void solve_lower_transposed(const ConstDenseColumns& L, DenseColumns B) {
  const PetscBLASInt m = blas_int(B.rows()), n = blas_int(B.cols()), l = stride(L), b = stride(B);
  const double one = 1;
  if (m > 0 && n > 0) BLAStrsm_("L", "L", "T", "N", &m, &n, &one, L.data(), &l, B.data(), &b);
}

// Halves of L leave most of it to products, which are twice as fast as OpenBLAS's triangular solutions.
void solve_lower_transposed_right(const ConstDenseColumns& L, DenseColumns B) {
  constexpr Eigen::Index kLargest = 96;  // rows of L
  const Eigen::Index n = L.rows(), half = n / 2;
  if (n > kLargest) {
    solve_lower_transposed_right(L.topLeftCorner(half, half), B.leftCols(half));
    multiply(Op::plain, Op::transposed, -1, B.leftCols(half), L.bottomLeftCorner(n - half, half), 1,
             B.rightCols(n - half));
    solve_lower_transposed_right(L.bottomRightCorner(n - half, n - half), B.rightCols(n - half));
    return;
  }
  const PetscBLASInt m = blas_int(B.rows()), k = blas_int(n), l = stride(L), b = stride(B);
  const double one = 1;
  if (m > 0 && k > 0) BLAStrsm_("R", "L", "T", "N", &m, &k, &one, L.data(), &l, B.data(), &b);
}

void subtract_square(const ConstDenseColumns& A, DenseColumns C) {
  const PetscBLASInt n = blas_int(C.rows()), k = blas_int(A.cols()), a = stride(A), c = stride(C);
  const double minus_one = -1, one = 1;
  if (n > 0 && k > 0) BLASsyrk_("L", "N", &n, &k, &minus_one, A.data(), &a, &one, C.data(), &c);
}

}  // namespace elastogear::reduction
