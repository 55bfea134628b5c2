#pragma once
// What a viscoelastic body remembers of its loads, with its deformation: a run may end and another one begin
// with it (docs/theory.md, sections 2.8 and 2.9).

#include <Eigen/Core>
#include <vector>

namespace elastogear::model {

struct RelaxedState {
  Eigen::VectorXd q;      ///< n_q
  Eigen::VectorXd tau;    ///< n_z, s, ascending
  Eigen::MatrixXd z;      ///< n_q x n_z, internal variables of the elastic coordinates
  std::vector<int> node;  ///< surface nodes (local numbers) that have been loaded, ascending
  /// 3 x (1 + n) numbers of each of these nodes, N, BRF: psi and eta_i of the n terms by which the residual
  /// displacement creeps.
  Eigen::MatrixXd force;

  bool empty() const { return q.size() == 0; }
};

}  // namespace elastogear::model
