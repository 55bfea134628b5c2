#pragma once
// Symmetric and Hermitian eigenproblems of some thousand rows, by LAPACK.

#include <Eigen/Core>

namespace elastogear::reduction {

/// Eigenvalues of the symmetric A, ascending; its upper triangle counts. A := the eigenvectors, orthonormal
/// columns. Throws Error when LAPACK fails.
Eigen::VectorXd diagonalise(Eigen::MatrixXd& A);
/// The same of the Hermitian A.
Eigen::VectorXd diagonalise(Eigen::MatrixXcd& A);

}  // namespace elastogear::reduction
