#include "dynamics/system_relaxation.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace elastogear::dynamics {

SystemRelaxation::SystemRelaxation(const SystemModel& model) : moduli_(model.environment.moduli) {
  for (const SystemModel::Body& body : model.bodies) {
    const Eigen::Index n_q = body.eq.n_q();
    Body own{body::relaxation_law(*body.eq.body), {}};
    own.last.q = model.U_0.segment(body.first + body.n_open(), n_q);
    own.last.z =
        body.relaxed.empty() ? Eigen::MatrixXd(Eigen::MatrixXd::Zero(n_q, own.law.n_z())) : body.relaxed.z;
    any_ = any_ || own.law.n_z() > 0;
    bodies_.push_back(std::move(own));
  }
}

void SystemRelaxation::begin_step(double dt, double alpha_f) {
  step_ = {dt, alpha_f};
  in_step_ = true;
}

// The difference of two times is that of the step but for the roundoff of the times.
body::StepPoint SystemRelaxation::point(std::size_t b, double time) const {
  constexpr double kRoundoff = 4 * std::numeric_limits<double>::epsilon();
  if (in_step_) return step_;
  const double elapsed = std::max(0.0, time - bodies_[b].last.time);
  const bool whole = std::abs(elapsed - step_.dt) <= kRoundoff * std::abs(time);
  return {whole ? step_.dt : elapsed, 1};
}

Eigen::MatrixXd SystemRelaxation::internal_variables(std::size_t b, double time,
                                                     const Eigen::VectorXd& q) const {
  const Body& body = bodies_[b];
  switch (moduli_) {
    case body::Moduli::instantaneous:
      return Eigen::MatrixXd::Zero(q.size(), body.law.n_z());
    case body::Moduli::long_term:
      return q.replicate(1, body.law.n_z());
    case body::Moduli::relaxing:
      break;
  }
  return body::internal_variables(body.law, body.last, point(b, time), q);
}

Eigen::VectorXd SystemRelaxation::following(std::size_t b, double time) const {
  const body::RelaxationLaw& law = bodies_[b].law;
  switch (moduli_) {
    case body::Moduli::instantaneous:
      return Eigen::VectorXd::Zero(law.g.rows());
    case body::Moduli::long_term:
      return law.g.rowwise().sum();
    case body::Moduli::relaxing:
      break;
  }
  return law.g * body::following_shares(law, point(b, time).dt);
}

void SystemRelaxation::accept(std::size_t b, double time, const Eigen::VectorXd& q) {
  Body& body = bodies_[b];
  if (body.law.n_z() > 0) body.last.z = internal_variables(b, time, q);
  body.last.q = q;
  body.last.time = time;
}

void SystemRelaxation::serialize(Archive& archive) {
  for (Body& body : bodies_) {
    if (body.law.n_z() == 0) continue;
    archive(body.last.time);
    archive(body.last.q);
    archive(body.last.z);
  }
}

}  // namespace elastogear::dynamics
