#include "elastogear/body/creep.h"

#include <Eigen/LU>
#include <cmath>
#include <utility>

namespace elastogear::body {

using Eigen::Index;
using Eigen::Vector3d;

std::vector<RelaxationLaw> creep_laws(const model::ElasticBody& body) {
  const model::Flexibility& flexibility = body.flexibility;
  std::vector<RelaxationLaw> laws;
  if (flexibility.creep >= 0 && body.relaxing[flexibility.creep].g.sum() > 0)
    laws.push_back({body.relaxing[flexibility.creep].tau, body.relaxing[flexibility.creep].g.transpose()});
  if (flexibility.relaxed.empty()) return laws;
  const RelaxationLaw all = relaxation_law(body);
  for (Index j = 0; j < flexibility.law.rows(); ++j)
    laws.push_back({all.tau, flexibility.law.row(j) * all.g});
  return laws;
}

Eigen::MatrixXd creep_coefficients(const model::Flexibility& flexibility) {
  const Index n = 1 + static_cast<Index>(flexibility.relaxed.size());
  Eigen::MatrixXd L = Eigen::MatrixXd::Ones(n, n);  // of law j in state k
  for (Index k = 1; k < n; ++k)
    L.col(k).tail(n - 1) = (1 - (flexibility.law * flexibility.relaxed[k - 1].share).array()).inverse();
  return L.partialPivLu().inverse();
}

Eigen::MatrixXd relaxed_stiffness(const model::ElasticBody& body, const Eigen::VectorXd& share) {
  Eigen::MatrixXd K = body.K_r;
  for (std::size_t p = 0; p < body.relaxing.size(); ++p)
    K -= share[static_cast<Index>(p)] * body.relaxing[p].K;
  return K;
}

CreepLaw::CreepLaw(RelaxationLaw law) : law_(std::move(law)) {
  if (law_.g.size() > 0 && law_.g.sum() > 0) g_ = law_.g.row(0);
  c_ = relaxed_ = Eigen::VectorXd::Zero(g_.size());
}

void CreepLaw::set_point(Moduli moduli, const StepPoint& at) {
  if (!creeps()) return;
  relaxed_.setZero();
  switch (moduli) {
    case Moduli::instantaneous:
      c_.setZero();
      break;
    case Moduli::long_term:
      c_.setOnes();
      break;
    case Moduli::relaxing:
      c_ = following_shares(law_, at.dt);
      relaxed_ = law_.tau.unaryExpr([&](double tau) { return -at.alpha * std::expm1(-at.dt / tau); });
      break;
  }
  rise_ = 1 / (1 - g_.dot(c_));
  at_once_ = g_.dot(c_) * rise_;
}

// eta_i at the point, for psi = 0 there.
Vector3d CreepLaw::kept(const CreepColumns& start, Index i) const {
  const auto psi = start.col(0), eta = start.col(1 + i);
  return eta + relaxed_[i] * (psi - eta) - c_[i] * psi;
}

Vector3d CreepLaw::lag(const CreepColumns& start) const {
  Vector3d sum = Vector3d::Zero();
  if (start.cols() > 0)
    for (Index i = 0; i < g_.size(); ++i) sum += g_[i] * kept(start, i);
  return rise_ * sum;
}

CreepState CreepLaw::state(const CreepColumns& start, const Vector3d& f) const {
  CreepState now(3, 1 + g_.size());
  const Vector3d psi = rise_ * f + lag(start);
  now.col(0) = psi;
  for (Index i = 0; i < g_.size(); ++i) {
    now.col(1 + i) = c_[i] * psi;
    if (start.cols() > 0) now.col(1 + i) += kept(start, i);
  }
  return now;
}

double CreepLaw::twice_energy(const CreepColumns& force, const CreepColumns& displaced) const {
  double sum = force.col(0).dot(displaced.col(0));
  for (Index i = 0; i < g_.size(); ++i)
    sum += g_[i] * (force.col(1 + i) - 2 * force.col(0)).dot(displaced.col(1 + i));
  return sum;
}

double CreepLaw::loss(const Pair& force, const Pair& displaced) const {
  double sum = 0;
  for (Index i = 0; i < g_.size(); ++i) {
    const Vector3d behind = force.from.col(0) + force.to.col(0) - force.from.col(1 + i) - force.to.col(1 + i);
    sum += 0.5 * g_[i] * behind.dot(displaced.to.col(1 + i) - displaced.from.col(1 + i));
  }
  return sum;
}

// Eq. (3.27a).
Eigen::MatrixXd CreepLaw::free_step() const {
  const Index n = g_.size();
  Eigen::MatrixXd kept = Eigen::MatrixXd::Zero(1 + n, n), step(1 + n, 1 + n);
  kept.row(0) = (relaxed_ - c_).transpose();
  kept.bottomRows(n).diagonal() = (1 - relaxed_.array()).matrix();
  step.col(0) = rise_ * kept * g_;
  step.rightCols(n) = step.col(0) * c_.transpose() + kept;
  return step;
}

double CreepLaw::twice_energy(const Eigen::MatrixXd& gram) const {
  const auto both = gram.diagonal().tail(g_.size()) - 2 * gram.row(0).tail(g_.size()).transpose();
  return gram(0, 0) + g_.dot(both);
}

double CreepLaw::free_loss(const Eigen::MatrixXd& gram) const {
  const Eigen::MatrixXd step = free_step(), same = Eigen::MatrixXd::Identity(step.rows(), step.cols()),
                        both = (same + step).transpose() * gram * (step - same);
  double sum = 0;
  for (Index i = 1; i <= g_.size(); ++i) sum += 0.5 * g_[i - 1] * (both(0, i) - both(i, i));
  return sum;
}

CreepLaws::CreepLaws(const std::vector<RelaxationLaw>& laws) {
  for (const RelaxationLaw& law : laws) laws_.emplace_back(law);
  if (creeps()) n_each_ = laws_.front().n_columns();
}

void CreepLaws::set_point(Moduli moduli, const StepPoint& at) {
  for (CreepLaw& law : laws_) law.set_point(moduli, at);
}

CreepColumns CreepLaws::columns(const CreepState& state, Index j) const {
  return state.cols() > 0 ? state.middleCols(j * n_each_, n_each_) : state.leftCols(0);
}

Vector3d CreepLaws::lag(const CreepState& start) const {
  Vector3d sum = Vector3d::Zero();
  for (Index j = 0; j < size(); ++j) sum += (*this)[j].lag(columns(start, j));
  return sum;
}

Vector3d CreepLaws::sum(const CreepState& state) const {
  Vector3d sum = Vector3d::Zero();
  for (Index j = 0; j < size(); ++j) sum += state.col(j * n_each_);
  return sum;
}

CreepState CreepLaws::state(const CreepState& start, const Vector3d& f) const {
  return displaced_state(start, CreepState(f.replicate(1, size())));
}

CreepState CreepLaws::displaced_state(const CreepState& start, const CreepColumns& displaced) const {
  CreepState now(3, n_columns());
  for (Index j = 0; j < size(); ++j)
    now.middleCols(j * n_each_, n_each_) = (*this)[j].state(columns(start, j), displaced.col(j));
  return now;
}

double CreepLaws::twice_energy(const CreepState& force, const CreepState& displaced) const {
  double sum = 0;
  for (Index j = 0; j < size(); ++j) sum += (*this)[j].twice_energy(columns(force, j), columns(displaced, j));
  return sum;
}

double CreepLaws::loss(const Pair& force, const Pair& displaced) const {
  double sum = 0;
  for (Index j = 0; j < size(); ++j)
    sum += (*this)[j].loss({columns(force.from, j), columns(force.to, j)},
                           {columns(displaced.from, j), columns(displaced.to, j)});
  return sum;
}

}  // namespace elastogear::body
