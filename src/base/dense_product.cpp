#include "elastogear/base/dense_product.h"

#include <petscsys.h>
#include <slepcblaslapack.h>

#include <algorithm>

// PETSc declares the routines of its own precision alone.
// NOLINTNEXTLINE(readability-identifier-naming): the name is BLAS's
extern "C" void sgemm_(const char* op_A, const char* op_B, const PetscBLASInt* m, const PetscBLASInt* n,
                       const PetscBLASInt* k, const float* alpha, const float* A, const PetscBLASInt* a,
                       const float* B, const PetscBLASInt* b, const float* beta, float* C,
                       const PetscBLASInt* c);

namespace elastogear {
namespace {

PetscBLASInt blas_int(Eigen::Index n) { return static_cast<PetscBLASInt>(n); }

template <class Columns>
PetscBLASInt stride(const Columns& A) {
  return blas_int(std::max<Eigen::Index>(1, A.outerStride()));
}

const char* letter(Op op) { return op == Op::transposed ? "T" : "N"; }

// gemm: of BLAS, in the precision of the columns.
template <class Gemm, class T, class Columns>
void product(Gemm gemm, Op op_A, Op op_B, T alpha, const Columns& A, const Columns& B, T beta, auto& C) {
  const PetscBLASInt m = blas_int(C.rows()), n = blas_int(C.cols()),
                     k = blas_int(op_A == Op::plain ? A.cols() : A.rows()), a = stride(A), b = stride(B),
                     c = stride(C);
  if (m == 0 || n == 0) return;
  gemm(letter(op_A), letter(op_B), &m, &n, &k, &alpha, A.data(), &a, B.data(), &b, &beta, C.data(), &c);
}

}  // namespace

void multiply(Op op_A, Op op_B, double alpha, const ConstDenseColumns& A, const ConstDenseColumns& B,
              double beta, DenseColumns C) {
  product(BLASgemm_, op_A, op_B, alpha, A, B, beta, C);
}

void multiply(Op op_A, Op op_B, float alpha, const ConstSingleColumns& A, const ConstSingleColumns& B,
              float beta, SingleColumns C) {
  product(sgemm_, op_A, op_B, alpha, A, B, beta, C);
}

}  // namespace elastogear
