#pragma once
// Relaxation of the viscoelastic bodies of a system: their internal variables at one state, from those of the
// last accepted one. Private to module dynamics.

#include <vector>

#include "elastogear/base/archive.h"
#include "elastogear/body/relaxation.h"
#include "elastogear/dynamics/system_model.h"

namespace elastogear::dynamics {

class SystemRelaxation {
 public:
  /// The elastic bodies of the model must outlive this.
  explicit SystemRelaxation(const SystemModel& model);

  bool any() const { return any_; }
  /// Relaxes the body?
  bool of(std::size_t b) const { return bodies_[b].law.n_z() > 0; }
  const body::RelaxationLaw& law(std::size_t b) const { return bodies_[b].law; }
  /// From here to end_step() states are taken at the stage of a step of dt (s), between its ends at the
  /// weight alpha_f of the new one; otherwise at the end of a step that begins at the last accepted state.
  void begin_step(double dt, double alpha_f);
  void end_step() { in_step_ = false; }
  /// After a state has been accepted within a step, as at rest: states are at the start of the next one.
  void close_step() {
    if (in_step_) step_ = {0, 1};
  }
  /// The last accepted state of a body, without the creep of its residual displacement.
  model::RelaxedState relaxed_state(std::size_t b) const {
    return {bodies_[b].last.q, bodies_[b].law.tau, bodies_[b].last.z, {}, {}};
  }

  /// z of the body at coordinates q, n_q x n_z.
  Eigen::MatrixXd internal_variables(std::size_t b, double time, const Eigen::VectorXd& q) const;
  /// Of each part the share of its stiffness that follows a change of q at once and is lost to the force,
  /// n_p. Eq. (3.24).
  Eigen::VectorXd following(std::size_t b, double time) const;
  /// The elastic coordinates of the body have come to q.
  void accept(std::size_t b, double time, const Eigen::VectorXd& q);
  void serialize(Archive& archive);
  body::Moduli moduli() const { return moduli_; }
  /// Where the state at this time is in the step that begins at the last accepted one.
  body::StepPoint point(std::size_t b, double time) const;

 private:
  struct Body {
    body::RelaxationLaw law;
    body::InternalState last;
  };

  std::vector<Body> bodies_;
  body::Moduli moduli_;
  bool any_ = false, in_step_ = false;
  body::StepPoint step_ = {};  // of the last stage
};

}  // namespace elastogear::dynamics
