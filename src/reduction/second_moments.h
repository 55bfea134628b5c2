#pragma once
// The second moments S^ab of shape functions (docs/theory.md, Eq. (3.11a)), model::Inertia::S_2.

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "elastogear/model/elastic_body.h"

namespace elastogear::reduction {

/// Second moments of modes that come one by one. The modes wait on disk until all are known, because every
/// pair of them is needed: 24 n_nodes bytes a mode. Memory: about 1 GB, and the 6 n_q x n_q results.
class SecondMoments {
 public:
  /// folder: of the waiting modes; must be of no other use, and goes in the end. M_s: fem::scalar_mass.
  SecondMoments(const std::string& folder, model::SparseRows M_s);
  ~SecondMoments();
  /// phi: 3 n_nodes, node-major.
  void add(const Eigen::VectorXd& phi);
  /// S^ab for ab = 11 22 33 12 23 13, n_q x n_q each, in 12 n_nodes n_q^2 operations. Once.
  std::vector<model::BasisRows> finish();

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// Second moments of the unit basis: the entries of M_s between directions a and b of the free displacements,
/// sparse.
std::vector<model::BasisRows> unit_second_moments(const model::SparseRows& M_s,
                                                  const std::vector<int>& free_dof);

}  // namespace elastogear::reduction
