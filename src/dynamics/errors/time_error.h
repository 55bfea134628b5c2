#pragma once
// The error that the steps of a run have left in elastic coordinates (docs/theory, section 8.8). Private
// to module dynamics.

#include <Eigen/Core>
#include <vector>

#include "elastogear/base/archive.h"

namespace elastogear::dynamics {

/// Masses, dampings and stiffnesses of oscillators that are not coupled.
struct Oscillators {
  Eigen::ArrayXd m, d, k;
};

/// Motions of the same oscillators within a time, each x" + (d/m) x' + (k/m) x = f: g follows an impulse 1 at
/// its start, and P_0, P_1, P_2 are those from rest under f = 1, t, t^2/2.
struct Responses {
  double duration = 0;  ///< s
  Eigen::ArrayXd g, g_dot, P_0, P_1, P_2;
};
/// At the end of `duration`, exact for any frequency and damping.
Responses responses(const Oscillators& of, double duration);

/// One step of generalised-alpha as integrated, of the coordinates of the oscillators.
struct IntegratedStep {
  double time, size;  ///< s, of its start
  double alpha_m, alpha_f;
  struct Motion {
    Eigen::Ref<const Eigen::VectorXd> U, V, A;
  } start, end;
};

/// Propagates the error of oscillators from step to step: computed less exact coordinates under the forces
/// that the steps found at their stages. In short steps it grows by the local errors of Eq. (8.22).
class TimeError {
 public:
  explicit TimeError(Oscillators of);
  Eigen::Index size() const { return of_.m.size(); }
  /// The motion starts at this time without an error, with an acceleration that solves the equations.
  void start(double time, const IntegratedStep::Motion& motion);
  /// had_impulse: the force of the step is that of an impulse, which no other step knows of.
  void follow(const IntegratedStep& step, bool had_impulse);
  /// Of the coordinates at the end of the last step.
  Eigen::VectorXd at_end() const { return error_; }
  /// Of coordinates U at a time within the last step.
  Eigen::VectorXd within(double time, const Eigen::Ref<const Eigen::VectorXd>& U) const;
  /// s, of the end of the last step.
  double end_time() const { return end_time_; }
  void serialize(Archive& archive);

 private:
  using Coordinates = Eigen::ArrayXd;
  struct Force {
    double time;        // s, from the end of the last step, so that steps of any size are told apart
    Coordinates value;  // over the mass
  };
  struct Polynomial {
    Coordinates c_0, c_1, c_2;  // c_0 + c_1 t + c_2 t^2/2
  };
  Coordinates force(const Coordinates& U, const Coordinates& V, const Coordinates& A) const;
  void add_force(const IntegratedStep& step);
  Polynomial acting() const;

  Oscillators of_;
  std::vector<Force> forces_;  // of the last stages, at most three
  Coordinates error_, error_rate_;
  double end_time_ = 0;
  Responses responses_;
  // State at the start of the last step and the modal forces during it; no columns after an impulse.
  double start_time_ = 0;
  Coordinates start_U_, start_V_, start_error_, start_error_rate_;
  Polynomial acting_;
};

}  // namespace elastogear::dynamics
