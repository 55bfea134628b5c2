#pragma once
// Products of large dense matrices by BLAS.

#include <Eigen/Core>

namespace elastogear {

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

}  // namespace elastogear
