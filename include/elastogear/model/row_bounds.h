#pragma once
// Bounds of the rows of a basis, which a body file holds so that a run need not read the rows: how they are
// found, and tested against rows that are read.

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "elastogear/model/elastic_body.h"

namespace elastogear::model {

/// Two nodes of a face, and their distance, m.
struct Edge {
  int node[2];
  double length;
};
/// Sides of some faces all over the surface, at most three of each of some hundred.
std::vector<Edge> watched_edges(const Surface& surface);
/// Differences of the rows of the edges' ends over their length, 3 n x n_q, 1/m.
DenseRows edge_rows(const BasisRows& Phi, const std::vector<Edge>& edges);

/// Largest eigenvalue of A_i diag(w) A_i' over the blocks A_i of three rows each.
double largest_square(const DenseRows& A, const Eigen::VectorXd& w);

/// Inverse diagonals of K_r and M_r.
struct RowWeights {
  Eigen::VectorXd compliance, mobility;
};
/// Nothing unless K_r and M_r are diagonal and positive.
std::optional<RowWeights> row_weights(const ElasticBody& body);

/// Bounds of the rows of body.surface.Phi; nothing for a sparse basis, without nodes or without weights.
std::optional<RowBounds> row_bounds(const ElasticBody& body);

/// Are the bounds of nodes first .. those of these rows (3 n x n_q), to roundoff?
bool are_bounds_of(const RowBounds& bounds, const RowWeights& weights, Eigen::Index first, Eigen::Index n,
                   const double* rows);

}  // namespace elastogear::model
