#pragma once
// Three rows of a matrix at once, those of a node in a basis, at the speed of memory. Rows stand one after
// the other, n numbers each.

#include <Eigen/Core>

namespace elastogear::model {

/// Products of the rows with x, which has n numbers.
Eigen::Vector3d three_products(const double* rows, const double* x, Eigen::Index n);

/// A diag(w) A' of the matrix A of the rows.
Eigen::Matrix3d weighted_squares(const double* rows, const double* w, Eigen::Index n);

/// y += f_0, f_1, f_2 times the rows.
void add_three_rows(const double* rows, const Eigen::Vector3d& f, double* y, Eigen::Index n);

}  // namespace elastogear::model
