#pragma once
// Linear complementarity: the forces of contacts without a penalty at unchanged closest points.

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace elastogear::dynamics {

/// p with 0 <= p, 0 <= q + C p and p'(q + C p) = 0, by block principal pivoting (J. J. Judice, F. M. Pires,
/// Computers & Operations Research 21, 1994, 587-596), which ends for every matrix whose principal minors are
/// positive. likely: which entries of p are not zero, as a first guess. Nothing where pivoting does not end.
std::optional<Eigen::VectorXd> solve_complementarity(const Eigen::MatrixXd& C, const Eigen::VectorXd& q,
                                                     std::vector<bool> likely);

}  // namespace elastogear::dynamics
