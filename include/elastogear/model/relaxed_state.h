#pragma once
// The state in which a viscoelastic body ends one run and begins another: its deformation and the internal
// variables of its relaxation (docs/theory, sections 2.8 and 2.9).

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
