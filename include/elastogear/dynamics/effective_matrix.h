#pragma once
// The data of the effective matrix A = shift_a dF/dA + shift_v dF/dV + dF/dU of the system, see
// low_rank_solver.h.

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

namespace elastogear::dynamics {

/// One body's entries. n_e = BorderColumns::size(node); r contact columns in the whole system.
struct BodyTerms {
  std::vector<int> node;                 ///< surface nodes touched by contact
  Eigen::MatrixXd C;                     ///< n_s x n_s
  Eigen::MatrixXd beta, rho;             ///< n_e x n_s
  Eigen::MatrixXd W_s, V_s;              ///< n_s x r
  Eigen::SparseMatrix<double> L;         ///< n_e x r
  Eigen::SparseMatrix<double> L_V = {};  ///< n_e x r, of V where it differs from that of W; or empty
  Eigen::SparseMatrix<double> L_x = {};  ///< n_e x r, L_V without rates, where it has some; or empty
  Eigen::MatrixXd R = {};                ///< 3 n x 3 n, m/N, residual flexibility of `node`; or empty
  Eigen::MatrixXd R_q, Q_s;  ///< n_s x n_q, n_q x n_s: of level full, see body/tangent.h, or empty
  Eigen::Matrix3d Gamma = Eigen::Matrix3d::Zero();
  Eigen::VectorXd following = {};  ///< n_p, of the relaxing parts, see ElasticBlock; or empty
};

struct EffectiveMatrix {
  double shift_v = 0, shift_a = 0;  ///< 1/s, 1/s^2
  std::vector<BodyTerms> body;
  Eigen::SparseMatrix<double> k;  ///< r x r, N/m
  Eigen::Index n_contact = 0;     ///< columns of contact, which are the first ones
};

}  // namespace elastogear::dynamics
