#pragma once
// The kernels of Eigen's dense products and triangular solutions. Every source that multiplies matrices would
// compile its own copies; the precompiled headers include this declaration instead (CMakeLists.txt of src and
// tests), and eigen_kernels.cpp holds the one copy. Without precompiled headers nothing changes but the time
// of a build.
#include <Eigen/Core>
#include <Eigen/LU>

// Kernels have other parameters in other versions of Eigen.
#if EIGEN_VERSION_AT_LEAST(3, 4, 0) && !EIGEN_VERSION_AT_LEAST(3, 4, 90)

namespace Eigen::internal {

using KernelTraits = gebp_traits<double, double>;
using KernelResult = blas_data_mapper<double, Index, ColMajor>;
template <int kOrder>
using KernelInput = const_blas_data_mapper<double, Index, kOrder>;

}  // namespace Eigen::internal

// prefix: `extern template struct` or `template struct`.
#define ELASTOGEAR_EIGEN_KERNELS(prefix)                                                                     \
  namespace Eigen::internal {                                                                                \
  prefix gebp_kernel<double, double, Index, KernelResult, KernelTraits::mr, KernelTraits::nr, false, false>; \
  prefix gemm_pack_lhs<double, Index, KernelInput<ColMajor>, KernelTraits::mr, KernelTraits::LhsProgress,    \
                       KernelTraits::LhsPacket4Packing, ColMajor>;                                           \
  prefix gemm_pack_lhs<double, Index, KernelInput<RowMajor>, KernelTraits::mr, KernelTraits::LhsProgress,    \
                       KernelTraits::LhsPacket4Packing, RowMajor>;                                           \
  prefix gemm_pack_rhs<double, Index, KernelInput<ColMajor>, KernelTraits::nr, ColMajor>;                    \
  prefix gemm_pack_rhs<double, Index, KernelInput<RowMajor>, KernelTraits::nr, RowMajor>;                    \
  prefix general_matrix_vector_product<Index, double, KernelInput<ColMajor>, ColMajor, false, double,        \
                                       KernelInput<ColMajor>, false>;                                        \
  prefix general_matrix_vector_product<Index, double, KernelInput<ColMajor>, ColMajor, false, double,        \
                                       KernelInput<RowMajor>, false>;                                        \
  prefix general_matrix_vector_product<Index, double, KernelInput<RowMajor>, RowMajor, false, double,        \
                                       KernelInput<ColMajor>, false>;                                        \
  prefix general_matrix_vector_product<Index, double, KernelInput<RowMajor>, RowMajor, false, double,        \
                                       KernelInput<RowMajor>, false>;                                        \
  prefix triangular_solve_matrix<double, Index, OnTheLeft, Lower, false, ColMajor, ColMajor, 1>;             \
  prefix triangular_solve_matrix<double, Index, OnTheLeft, UnitLower, false, ColMajor, ColMajor, 1>;         \
  prefix triangular_solve_matrix<double, Index, OnTheLeft, Upper, false, ColMajor, ColMajor, 1>;             \
  }

ELASTOGEAR_EIGEN_KERNELS(extern template struct)

#endif
