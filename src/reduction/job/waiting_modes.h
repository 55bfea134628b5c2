#pragma once
// Modes that wait on disk until all are known, for what needs every pair of them.

#include <Eigen/Core>
#include <memory>
#include <string>

#include "elastogear/model/elastic_body.h"

namespace elastogear::reduction {

/// 24 n_nodes bytes a mode on disk.
class WaitingModes {
 public:
  /// folder: of the waiting modes; must be of no other use, and goes in the end.
  explicit WaitingModes(const std::string& folder);
  ~WaitingModes();
  /// phi: 3 n_nodes, node-major, in place of one that was added as mode k before, or next to the last one.
  void add(int k, const Eigen::VectorXd& phi);
  /// To be called before modes are read, and again after more of them have been added.
  void close();
  Eigen::Index size() const;
  /// Modes that fit into a block of memory of this size (at least one), for 3 n_nodes displacements.
  Eigen::Index block_width(Eigen::Index n_dofs) const;
  /// Columns first .. first + count - 1 of Phi, 3 n_nodes x count.
  Eigen::MatrixXd block(Eigen::Index first, Eigen::Index count) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// Phi' K Phi of closed modes, n_q x n_q, symmetric; K: 3 n_nodes square and symmetric. Memory: about 1 GB.
Eigen::MatrixXd project(const WaitingModes& modes, const model::SparseRows& K);

}  // namespace elastogear::reduction
