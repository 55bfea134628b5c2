#include "elastogear/dynamics/low_rank_solver.h"

#include <Eigen/LU>
#include <algorithm>

#include "elastogear/base/error.h"
#include "elastogear/body/deformed_inertia.h"

namespace elastogear::dynamics {
namespace {

const Eigen::SparseMatrix<double>& rows_of(const BodyTerms& t) { return t.L_V.rows() > 0 ? t.L_V : t.L; }

const Eigen::SparseMatrix<double>& position_rows(const BodyTerms& t) {
  return t.L_x.rows() > 0 ? t.L_x : rows_of(t);
}

// R on all columns of E: those of the nodes are the last.
Eigen::MatrixXd residual_displacement(const BodyTerms& t, const Eigen::MatrixXd& X) {
  Eigen::MatrixXd Y = Eigen::MatrixXd::Zero(X.rows(), X.cols());
  if (t.R.size() > 0) Y.bottomRows(t.R.rows()).noalias() = t.R * X.bottomRows(t.R.rows());
  return Y;
}

// X' R on all columns of E.
Eigen::MatrixXd residual_displacement_rows(const BodyTerms& t, const Eigen::MatrixXd& X) {
  Eigen::MatrixXd Y = Eigen::MatrixXd::Zero(X.cols(), X.rows());
  if (t.R.size() > 0) Y.rightCols(t.R.cols()).noalias() = X.bottomRows(t.R.rows()).transpose() * t.R;
  return Y;
}

// L_V'G + L_x'R. Products of a sparse matrix that run down the columns of the dense one are the fast ones; G
// is not symmetric where D^-1 is only approximated.
Eigen::MatrixXd responses(const BodyTerms& t, const Eigen::MatrixXd& G) {
  const Eigen::MatrixXd G_t = G.transpose();
  Eigen::MatrixXd rows = (G_t * rows_of(t)).transpose();
  if (t.R.size() > 0) rows += residual_displacement_rows(t, position_rows(t));
  return rows;
}

}  // namespace

LowRankSolver::LowRankSolver(const std::vector<SolverBody>& bodies) {
  Eigen::Index start = 0;
  for (const auto& [eq, n_s, markers] : bodies) {
    eq_.push_back(eq);
    range_.push_back({start, n_s, eq->n_q(), n_s_});
    block_.emplace_back(*eq, markers);
    start += n_s + eq->n_q();
    n_s_ += n_s;
  }
}

bool LowRankSolver::is_exact() const {
  return std::all_of(block_.begin(), block_.end(), [](const ElasticBlock& D) { return D.is_exact(); });
}

void LowRankSolver::add_body(std::size_t b, Eigen::MatrixXd& small) {
  const BodyTerms& t = A_.body[b];
  const auto [s, n_s, n_q, joint] = range_[b];
  const Eigen::Index r = A_.k.rows();
  const Eigen::MatrixXd G = block_[b].compliance(t.node), V_responses = responses(t, G),
                        rho_responses = t.rho.transpose() * G + residual_displacement_rows(t, t.rho);
  const Eigen::SparseMatrix<double> L_k = t.L * A_.k;
  small.block(joint, joint, n_s, n_s) += t.C - rho_responses * t.beta;
  small.block(joint, n_s_, n_s, r) += t.W_s * A_.k - rho_responses * L_k;
  small.block(n_s_, joint, r, n_s) += V_responses * t.beta - t.V_s.transpose();
  small.bottomRightCorner(r, r) += V_responses * L_k;
}

// The dense matrix of the system that stays: docs/theory.md, Eq. (8.16).
void LowRankSolver::set(EffectiveMatrix A) {
  A_ = std::move(A);
  const Eigen::Index r = A_.k.rows();
  Eigen::MatrixXd small = Eigen::MatrixXd::Zero(n_s_ + r, n_s_ + r);
  small.bottomRightCorner(r, r).setIdentity();
  for (std::size_t b = 0; b < block_.size(); ++b) {
    block_[b].set_shifts(A_.shift_v, A_.shift_a, A_.body[b].following);
    add_body(b, small);
  }
  require(small.allFinite(), "the effective matrix is not finite");
  lu_.set(std::move(small));
}

// k lambda, lambda = V'x + L_x'w of all bodies with w = -R (beta x_s + L k lambda); projected: E'x_q.
Eigen::VectorXd LowRankSolver::contact_forces(const Eigen::VectorXd& x,
                                              const std::vector<Eigen::VectorXd>& projected) const {
  const Eigen::Index r = A_.k.rows();
  Eigen::VectorXd lambda = Eigen::VectorXd::Zero(r);
  Eigen::MatrixXd with_residual = Eigen::MatrixXd::Identity(r, r);
  bool has_residual = false;
  for (std::size_t b = 0; b < block_.size(); ++b) {
    const BodyTerms& t = A_.body[b];
    const auto x_s = x.segment(range_[b].s, range_[b].n_s);
    lambda += t.V_s.transpose() * x_s + rows_of(t).transpose() * projected[b];
    if (t.R.size() == 0) continue;
    has_residual = true;
    lambda -= position_rows(t).transpose() * residual_displacement(t, t.beta * x_s).col(0);
    with_residual += position_rows(t).transpose() * residual_displacement(t, t.L) * A_.k;
  }
  return A_.k * (has_residual ? Eigen::VectorXd(with_residual.partialPivLu().solve(lambda)) : lambda);
}

Eigen::VectorXd LowRankSolver::multiply(const Eigen::VectorXd& x) const {
  Eigen::VectorXd y(x.size());
  std::vector<Eigen::VectorXd> projected;
  for (std::size_t b = 0; b < block_.size(); ++b) {
    const auto [s, n_s, n_q, joint] = range_[b];
    projected.push_back(block_[b].columns().project(A_.body[b].node, x.segment(s + n_s, n_q)));
  }
  const Eigen::VectorXd k_lambda = contact_forces(x, projected);
  for (std::size_t b = 0; b < block_.size(); ++b) {
    const auto [s, n_s, n_q, joint] = range_[b];
    const BodyTerms& t = A_.body[b];
    const auto x_s = x.segment(s, n_s);
    const Eigen::VectorXd load = t.beta * x_s + t.L * k_lambda;
    y.segment(s, n_s) =
        t.C * x_s + t.rho.transpose() * (projected[b] - residual_displacement(t, load)) + t.W_s * k_lambda;
    y.segment(s + n_s, n_q) =
        block_[b].multiply(x.segment(s + n_s, n_q)) + block_[b].columns().expand(t.node, load);
    if (t.Q_s.rows() > 0) add_second_order(b, x, y);
  }
  return y;
}

void LowRankSolver::add_second_order(std::size_t b, const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  const auto [s, n_s, n_q, joint] = range_[b];
  const BodyTerms& t = A_.body[b];
  const Eigen::VectorXd x_q = x.segment(s + n_s, n_q);
  y.segment(s, n_s) += t.R_q * x_q;
  y.segment(s + n_s, n_q) += t.Q_s * x.segment(s, n_s) + body::contract(eq_[b]->body->inertia, t.Gamma, x_q);
}

Eigen::VectorXd LowRankSolver::solve(const Eigen::VectorXd& y) const {
  Eigen::VectorXd x(y.size()), right = Eigen::VectorXd::Zero(n_s_ + A_.k.rows());
  for (std::size_t b = 0; b < block_.size(); ++b) {
    const auto [s, n_s, n_q, joint] = range_[b];
    const BodyTerms& t = A_.body[b];
    x.segment(s + n_s, n_q) = block_[b].solve(y.segment(s + n_s, n_q));
    const Eigen::VectorXd p = block_[b].columns().project(t.node, x.segment(s + n_s, n_q));
    right.segment(joint, n_s) = y.segment(s, n_s) - t.rho.transpose() * p;
    right.tail(A_.k.rows()) += rows_of(t).transpose() * p;
  }
  const Eigen::VectorXd small = lu_.solve(std::move(right));
  const Eigen::VectorXd k_lambda = A_.k * small.tail(A_.k.rows());
  for (std::size_t b = 0; b < block_.size(); ++b) {
    const auto [s, n_s, n_q, joint] = range_[b];
    const BodyTerms& t = A_.body[b];
    const Eigen::VectorXd x_s = small.segment(joint, n_s);
    x.segment(s, n_s) = x_s;
    x.segment(s + n_s, n_q) -= block_[b].response(t.node, t.beta * x_s + t.L * k_lambda);
  }
  return x;
}

void LowRankSolver::on_solve(const std::function<void()>& pulse) {
  for (ElasticBlock& block : block_) block.on_solve(pulse);
}

void LowRankSolver::serialize(Archive& archive) {
  for (ElasticBlock& block : block_) block.serialize(archive);
}

}  // namespace elastogear::dynamics
