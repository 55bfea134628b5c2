#pragma once
// Products (of base), Cholesky factors and triangular solutions of large dense matrices by BLAS and LAPACK.

#include <Eigen/Core>

#include "elastogear/base/dense_product.h"

namespace elastogear::reduction {

using elastogear::ConstDenseColumns;
using elastogear::ConstSingleColumns;
using elastogear::DenseColumns;
using elastogear::multiply;
using elastogear::Op;
using elastogear::SingleColumns;

/// The lower triangle of A becomes L of A = L L', of which it is read. Returns false where A is not positive
/// definite.
bool cholesky(DenseColumns A);

/// B := L^-1 B.
void solve_lower(const ConstDenseColumns& L, DenseColumns B);
/// B := L^-T B.
void solve_lower_transposed(const ConstDenseColumns& L, DenseColumns B);
/// B := B L^-T.
void solve_lower_transposed_right(const ConstDenseColumns& L, DenseColumns B);

/// The lower triangle of C := C - A A'.
void subtract_square(const ConstDenseColumns& A, DenseColumns C);

}  // namespace elastogear::reduction
