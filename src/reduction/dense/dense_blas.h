#pragma once
// Products, Cholesky factors and triangular solutions of large dense matrices by BLAS and LAPACK.

#include <Eigen/Core>

namespace elastogear::reduction {

using DenseColumns = Eigen::Ref<Eigen::MatrixXd>;
using ConstDenseColumns = Eigen::Ref<const Eigen::MatrixXd>;
using SingleColumns = Eigen::Ref<Eigen::MatrixXf>;
using ConstSingleColumns = Eigen::Ref<const Eigen::MatrixXf>;

enum class Op { plain, transposed };

/// C := alpha op(A) op(B) + beta C.
void multiply(Op op_A, Op op_B, double alpha, const ConstDenseColumns& A, const ConstDenseColumns& B,
              double beta, DenseColumns C);
/// The same in single precision.
void multiply(Op op_A, Op op_B, float alpha, const ConstSingleColumns& A, const ConstSingleColumns& B,
              float beta, SingleColumns C);

/// The lower triangle of A becomes L of A = L L', of which it is read. Returns false where A is not positive
/// definite.
bool cholesky(DenseColumns A);

/// B := L^-1 B.
void solve_lower(const ConstDenseColumns& L, DenseColumns B);
/// B := B L^-T.
void solve_lower_transposed_right(const ConstDenseColumns& L, DenseColumns B);

}  // namespace elastogear::reduction
