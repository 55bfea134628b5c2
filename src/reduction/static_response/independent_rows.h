#pragma once
// Rows of the stress operator that are independent of each other: at a free surface three of the six
// components of the stress are without traction, and at an edge of two such surfaces five.

#include <Eigen/Core>
#include <vector>

#include "elastogear/model/elastic_body.h"

namespace elastogear::reduction {

/// The six rows of node i are Q(:, first[i]..first[i+1]) times as many rows of W.
struct IndependentRows {
  std::vector<int> first{0};
  Eigen::Matrix<double, 6, Eigen::Dynamic> Q = {};  ///< orthonormal columns of each node
  model::SparseRows W = {};

  int n_nodes() const { return static_cast<int>(first.size()) - 1; }
};

/// S: rows of a stress operator, six of each node. docs/theory, Eq. (1.15).
IndependentRows independent_rows(const model::SparseRows& S);

}  // namespace elastogear::reduction
