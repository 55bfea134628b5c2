// Tolerances of the step-size control in lengths, and care where contact begins.
#include <algorithm>
#include <cmath>

#include "dynamics/run.h"
#include "dynamics/vec_view.h"
#include "elastogear/dynamics/generalized_alpha.h"

namespace elastogear::dynamics {
namespace {

constexpr double kFirstTouch = 0.1;  // share of the contact depth that bodies may enter in their first step
constexpr double kShortestStep = 1e-3;  // of the first one, down to which touch is looked for

// Largest distance from the joint's centre.
double reach(const System::Body& body) {
  const Eigen::Vector3d point =
      body.eq.joint.type == body::JointType::free ? Eigen::Vector3d::Zero() : body.eq.joint.point;
  const Eigen::Matrix3Xd& X = body.eq.body->surface.X;
  if (X.cols() > 0) return std::sqrt((X.colwise() - point).colwise().squaredNorm().maxCoeff());
  const model::Inertia& inertia = body.eq.body->inertia;
  return std::sqrt(inertia.J.trace() / (2 * inertia.m));  // radius of gyration
}

// Amplitudes of the elastic coordinates whose largest displacement of a surface node is 1 m; without a
// surface those with the kinetic energy of the whole body at 1 m.
Eigen::VectorXd amplitudes(const model::ElasticBody& body) {
  if (body.basis == model::Basis::full) return Eigen::VectorXd::Ones(body.n_q());
  Eigen::VectorXd q = (body.inertia.m / Eigen::VectorXd(body.M_r.diagonal()).array()).sqrt();
  const auto* Phi = std::get_if<model::DenseRows>(&body.surface.Phi);
  if (!Phi || Phi->rows() == 0) return q;
  const Eigen::VectorXd largest = Phi->cwiseAbs().colwise().maxCoeff();
  for (Eigen::Index k = 0; k < q.size(); ++k)
    if (largest[k] > 0) q[k] = 1 / largest[k];
  return q;
}

bool is_angle(body::JointType type, Eigen::Index i) {
  if (type == body::JointType::free) return i >= 3;
  return type == body::JointType::spherical || (body::has_rotation_axis(type) && i == 0);
}

PetscErrorCode accept_touch(TSAdapt, TS ts, PetscReal t, Vec U, PetscBool* accept) {
  Run* run = nullptr;
  PetscCall(TSGetApplicationContext(ts, &run));
  return guard(run->problem.pending, [&] {
    PetscReal dt = 0;
    check(TSGetTimeStep(ts, &dt));
    if (run->touches || dt <= kShortestStep * run->nominal_dt) return;
    System& system = run->problem.system;
    const Eigen::VectorXd V = Eigen::VectorXd::Zero(system.size());  // without influence on the depth
    if (system.depth_share(t, *ReadView(U), V) > kFirstTouch) *accept = PETSC_FALSE;
  });
}

}  // namespace

Eigen::VectorXd coordinates_per_length(const System& system) {
  Eigen::VectorXd scale(system.size());
  for (const System::Body& body : system.bodies()) {
    for (Eigen::Index i = 0; i < body.n_open(); ++i) {
      const bool angle = is_angle(body.eq.joint.type, body.open[static_cast<std::size_t>(i)]);
      scale[body.first + i] = angle ? 1 / reach(body) : 1;
    }
    scale.segment(body.first + body.n_open(), body.eq.n_q()) = amplitudes(*body.eq.body);
  }
  return scale;
}

void control_steps(const Run& run, TS ts) {
  const TimeSettings& settings = run.settings;
  if (settings.step_tolerance <= 0) return;
  TSAdapt adapt = nullptr;
  check(TSGetAdapt(ts, &adapt));
  check(TSAdaptSetType(adapt, TSADAPTBASIC));
  check(TSAdaptSetCheckStage(adapt, accept_touch));
  const UniqueVec scale = vector(coordinates_per_length(run.problem.system));
  generalized_alpha_set_tolerances(ts, scale, settings.step_tolerance, settings.velocity_tolerance);
}

}  // namespace elastogear::dynamics
