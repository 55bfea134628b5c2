#pragma once
// Orthonormal columns that sort what rows know of each other (docs/theory, Eq. (6.20c)).

#include <Eigen/Core>

namespace elastogear::reduction {

/// V, orthonormal, such that the columns of A V come in about ascending order of their lengths and the last
/// ones hold as much of A as any so few can, nearly (pivoted QLP decomposition). gram: A' A, whose lower
/// triangle counts. G. W. Stewart, SIAM J. Sci. Comput. 20 (1999) 1336-1348.
Eigen::MatrixXd directions(Eigen::MatrixXd gram);

}  // namespace elastogear::reduction
