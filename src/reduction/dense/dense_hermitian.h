#pragma once
// Hermitian systems of some thousand rows, by LAPACK.

#include <Eigen/Core>
#include <vector>

namespace elastogear::reduction {

/// The lower triangle of A becomes L D L^H of A (Bunch and Kaufman), of which it is read. Returns the number
/// of negative eigenvalues. Throws Error where a pivot is zero.
int factorise_hermitian(Eigen::MatrixXcd& A, std::vector<int>& pivot);

/// B := A^-1 B from its factor.
void solve_hermitian(const Eigen::MatrixXcd& factor, const std::vector<int>& pivot, Eigen::MatrixXcd& B);

/// The lower triangle of A, which is read, becomes L of A = L L^H. Returns false where A is not positive
/// definite.
bool cholesky_hermitian(Eigen::MatrixXcd& A);

/// B := (L L^H)^-1 B.
void solve_cholesky(const Eigen::MatrixXcd& L, Eigen::MatrixXcd& B);

}  // namespace elastogear::reduction
