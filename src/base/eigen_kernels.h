#pragma once
// The kernels of Eigen's dense products and triangular solutions, and its decompositions of matrices. Every
// source that multiplies or factorises matrices would compile its own copies; the precompiled headers include
// this declaration instead (CMakeLists.txt of src and tests), and eigen_kernels.cpp holds the one copy.
// Without precompiled headers nothing changes but the time of a build.
#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

// Kernels have other parameters in other versions of Eigen.
#if EIGEN_VERSION_AT_LEAST(3, 4, 0) && !EIGEN_VERSION_AT_LEAST(3, 4, 90)

namespace Eigen::internal {

using KernelTraits = gebp_traits<double, double>;
using KernelResult = blas_data_mapper<double, Index, ColMajor>;
template <int kOrder>
using KernelInput = const_blas_data_mapper<double, Index, kOrder>;

}  // namespace Eigen::internal

// prefix: `extern template` or `template`, which parentheses would break.
// NOLINTBEGIN(bugprone-macro-parentheses)
#define ELASTOGEAR_EIGEN_KERNELS(prefix)                                                                     \
  namespace Eigen::internal {                                                                                \
  prefix struct gebp_kernel<double, double, Index, KernelResult, KernelTraits::mr, KernelTraits::nr, false,  \
                            false>;                                                                          \
  prefix struct gemm_pack_lhs<double, Index, KernelInput<ColMajor>, KernelTraits::mr,                        \
                              KernelTraits::LhsProgress, KernelTraits::LhsPacket4Packing, ColMajor>;         \
  prefix struct gemm_pack_lhs<double, Index, KernelInput<RowMajor>, KernelTraits::mr,                        \
                              KernelTraits::LhsProgress, KernelTraits::LhsPacket4Packing, RowMajor>;         \
  prefix struct gemm_pack_rhs<double, Index, KernelInput<ColMajor>, KernelTraits::nr, ColMajor>;             \
  prefix struct gemm_pack_rhs<double, Index, KernelInput<RowMajor>, KernelTraits::nr, RowMajor>;             \
  prefix struct general_matrix_vector_product<Index, double, KernelInput<ColMajor>, ColMajor, false, double, \
                                              KernelInput<ColMajor>, false>;                                 \
  prefix struct general_matrix_vector_product<Index, double, KernelInput<ColMajor>, ColMajor, false, double, \
                                              KernelInput<RowMajor>, false>;                                 \
  prefix struct general_matrix_vector_product<Index, double, KernelInput<RowMajor>, RowMajor, false, double, \
                                              KernelInput<ColMajor>, false>;                                 \
  prefix struct general_matrix_vector_product<Index, double, KernelInput<RowMajor>, RowMajor, false, double, \
                                              KernelInput<RowMajor>, false>;                                 \
  prefix struct triangular_solve_matrix<double, Index, OnTheLeft, Lower, false, ColMajor, ColMajor, 1>;      \
  prefix struct triangular_solve_matrix<double, Index, OnTheLeft, UnitLower, false, ColMajor, ColMajor, 1>;  \
  prefix struct triangular_solve_matrix<double, Index, OnTheLeft, Upper, false, ColMajor, ColMajor, 1>;      \
  }

// The members that do the work: those around them are inline and small.
#define ELASTOGEAR_EIGEN_DECOMPOSITIONS(prefix)                                                             \
  namespace Eigen {                                                                                         \
  prefix LLT<MatrixXd>& LLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);                                 \
  prefix LLT<Matrix3d>& LLT<Matrix3d>::compute(const EigenBase<Matrix3d>&);                                 \
  prefix LDLT<MatrixXd>& LDLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);                               \
  prefix void PartialPivLU<MatrixXd>::compute();                                                            \
  prefix void HouseholderQR<MatrixXd>::computeInPlace();                                                    \
  prefix void HouseholderQR<MatrixXd>::_solve_impl(const VectorXd&, VectorXd&) const;                       \
  prefix void ColPivHouseholderQR<MatrixXd>::computeInPlace();                                              \
  prefix SelfAdjointEigenSolver<Matrix3d>& SelfAdjointEigenSolver<Matrix3d>::compute(                       \
      const EigenBase<Matrix3d>&, int);                                                                     \
  prefix SelfAdjointEigenSolver<MatrixXd>& SelfAdjointEigenSolver<MatrixXd>::compute(                       \
      const EigenBase<MatrixXd>&, int);                                                                     \
  prefix GeneralizedSelfAdjointEigenSolver<MatrixXd>& GeneralizedSelfAdjointEigenSolver<MatrixXd>::compute( \
      const MatrixXd&, const MatrixXd&, int);                                                               \
  namespace internal {                                                                                      \
  prefix void tridiagonalization_inplace(MatrixXd&, VectorXd&);                                             \
  prefix void tridiagonalization_inplace(MatrixXd&, VectorXd&, VectorXd&, VectorXd&, bool);                 \
  }                                                                                                         \
  }

// NOLINTEND(bugprone-macro-parentheses)

ELASTOGEAR_EIGEN_KERNELS(extern template)
ELASTOGEAR_EIGEN_DECOMPOSITIONS(extern template)

#endif
