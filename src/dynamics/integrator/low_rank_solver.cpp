#include "elastogear/dynamics/low_rank_solver.h"

#include <Eigen/LU>
#include <algorithm>

#include "dynamics/contact/low_rank_columns.h"
#include "elastogear/body/deformed_inertia.h"

namespace elastogear::dynamics {
namespace {

// R on all columns of E: those of the nodes are the last.
Eigen::MatrixXd residual_displacement(const BodyTerms& t, const Eigen::MatrixXd& X) {
  Eigen::MatrixXd Y = Eigen::MatrixXd::Zero(X.rows(), X.cols());
  if (t.R.size() > 0) Y.bottomRows(t.R.rows()).noalias() = t.R * X.bottomRows(t.R.rows());
  return Y;
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

void LowRankSolver::set(EffectiveMatrix A) {
  A_ = std::move(A);
  std::vector<CondensedBody> bodies;
  for (std::size_t b = 0; b < block_.size(); ++b) {
    block_[b].set_shifts(A_.shift_v, A_.shift_a, A_.body[b].following);
    bodies.push_back({range_[b].joint, range_[b].n_s, block_[b].compliance(A_.body[b].node)});
  }
  condensed_.set(A_, std::move(bodies));
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
    lambda += t.V_s.transpose() * x_s + displacement_rows(t).transpose() * projected[b];
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

Eigen::VectorXd LowRankSolver::solve(const Eigen::VectorXd& y, double left) const {
  Eigen::VectorXd x(y.size()), right = Eigen::VectorXd::Zero(n_s_ + A_.k.rows());
  for (std::size_t b = 0; b < block_.size(); ++b) {
    const auto [s, n_s, n_q, joint] = range_[b];
    const BodyTerms& t = A_.body[b];
    x.segment(s + n_s, n_q) = block_[b].solve_load(y.segment(s + n_s, n_q));
    const Eigen::VectorXd p = block_[b].columns().project(t.node, x.segment(s + n_s, n_q));
    right.segment(joint, n_s) = y.segment(s, n_s) - t.rho.transpose() * p;
    right.tail(A_.k.rows()) += displacement_rows(t).transpose() * p;
  }
  const Eigen::VectorXd small = condensed_.solve(A_, right, left);
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
