#include "elastogear/body/creep.h"

#include <cmath>
#include <utility>

namespace elastogear::body {

using Eigen::Index;
using Eigen::Vector3d;

RelaxationLaw creep_law(const model::ElasticBody& body) {
  const int part = body.flexibility.creep;
  if (part < 0) return {};
  return {body.relaxing[part].tau, body.relaxing[part].g.transpose()};
}

Eigen::MatrixXd long_term_stiffness(const model::ElasticBody& body) {
  Eigen::MatrixXd K = body.K_r;
  for (const model::RelaxingPart& part : body.relaxing) K -= part.g.sum() * part.K;
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
Vector3d CreepLaw::kept(const CreepState& start, Index i) const {
  const auto psi = start.col(0), eta = start.col(1 + i);
  return eta + relaxed_[i] * (psi - eta) - c_[i] * psi;
}

Vector3d CreepLaw::lag(const CreepState& start) const {
  Vector3d sum = Vector3d::Zero();
  if (start.cols() > 0)
    for (Index i = 0; i < g_.size(); ++i) sum += g_[i] * kept(start, i);
  return rise_ * sum;
}

CreepState CreepLaw::state(const CreepState& start, const Vector3d& f) const {
  CreepState now(3, 1 + g_.size());
  const Vector3d psi = rise_ * f + lag(start);
  now.col(0) = psi;
  for (Index i = 0; i < g_.size(); ++i) {
    now.col(1 + i) = c_[i] * psi;
    if (start.cols() > 0) now.col(1 + i) += kept(start, i);
  }
  return now;
}

double CreepLaw::twice_energy(const CreepState& force, const CreepState& displaced) const {
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

}  // namespace elastogear::body
