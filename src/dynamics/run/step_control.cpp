// Tolerances of the step-size control in lengths, and care where contact begins.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "dynamics/integrator/vec_view.h"
#include "dynamics/run/run.h"
#include "dynamics/run/snapshot.h"
#include "elastogear/dynamics/advice.h"
#include "elastogear/dynamics/generalized_alpha.h"

namespace elastogear::dynamics {
namespace {

constexpr double kFirstTouch = 0.1;  // share of the contact depth that bodies may enter in their first step
// Contact may store at most so many times step_error of the energy of the motion in the step of first touch.
constexpr double kTouchEnergy = 2;
constexpr double kShortestStep = 1e-3;  // of the first one, down to which touch is looked for
constexpr double kFirstStep = 0.1;      // of what advice asks for
constexpr double kFirstShare = 1e-3;    // of the run, that the first step takes at most
constexpr double kMostError = 2;        // of the tolerated error, with which a step is still taken
constexpr double kSafety = 0.9;         // of the step that would have the tolerated error
// A step over the one before, at most and at least. Below this bound no sequence that was looked for makes
// energy of vibrations with rho_inf up to 0.8 (docs/theory, section 8.3); the least one is PETSc's.
constexpr double kMostGrowth = 1.5, kMostCut = 0.1;
// Displacements over the size of the bodies: one that stands for elastic displacements that are smaller, and
// one that stands for them where no body is elastic.
constexpr double kSmallDisplacement = 1e-5, kRigidDisplacement = 1e-3;

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
  if (model::row_count(body.surface.Phi) == 0) return q;
  const model::RowBounds* known = model::known_bounds(body.surface.Phi);
  const Eigen::VectorXd largest =
      known ? known->largest : model::dense_rows(body.surface.Phi)->cwiseAbs().colwise().maxCoeff();
  for (Eigen::Index k = 0; k < q.size(); ++k)
    if (largest[k] > 0) q[k] = 1 / largest[k];
  return q;
}

bool are_steps_chosen(const TimeSettings& settings) {
  return !settings.relax && (settings.dt == 0 || settings.step_tolerance > 0);
}

// Amplitudes of the vibrations that the elastic coordinates of a state belong to: of a modal basis with the
// velocities, so that they do not vanish when a vibration passes through zero.
Eigen::VectorXd vibration(const model::ElasticBody& body, const model::BodyState& state) {
  if (body.basis == model::Basis::full) return state.q.cwiseAbs();
  const Eigen::ArrayXd elastic = body.K_r.diagonal().array() * state.q.array().square(),
                       kinetic = body.M_r.diagonal().array() * state.q_dot.array().square();
  return ((elastic + kinetic) / body.K_r.diagonal().array()).sqrt();
}

// Largest elastic displacement by one coordinate or by contact forces that have static responses, m.
double elastic_displacement(Run& run) {
  System& system = run.problem.system;
  double largest = 0;
  for (std::size_t b = 0; b < system.bodies().size(); ++b) {
    const System::Body& body = system.bodies()[b];
    const model::BodyState& state = run.last->bodies[b];
    if (state.q.size() == 0) continue;
    const auto per_length = run.control.per_length.segment(body.first + body.n_open(), state.q.size());
    largest = std::max(largest, vibration(*body.eq.body, state).cwiseQuotient(per_length).maxCoeff());
    const double force = state.contact.f_B.colwise().norm().sum();
    if (force > 0) largest = std::max(largest, 2 * system.residual_energy(b) / force);
  }
  return largest;
}

// How far the local error of a step may move a surface node at most, m.
double tolerance(const Run& run) {
  if (run.settings.step_tolerance > 0) return run.settings.step_tolerance;
  const std::vector<System::Body>& bodies = run.problem.system.bodies();
  const bool any_elastic =
      std::any_of(bodies.begin(), bodies.end(), [](const auto& body) { return body.eq.n_q() > 0; });
  const double least = (any_elastic ? kSmallDisplacement : kRigidDisplacement) * run.control.size;
  return kMostError * run.settings.step_error * std::max(run.control.displacement, least);
}

// Is the tolerated error of steps a share of what there is?
bool has_step_error(const TimeSettings& settings) {
  return are_steps_chosen(settings) && settings.step_tolerance == 0;
}

// J/m^2, of a body: twice the elastic energy of the softest coordinate that moves the surface by up to 1 m.
double softest(const System::Body& body, const Eigen::VectorXd& per_length) {
  const model::ElasticBody& elastic = *body.eq.body;
  if (elastic.basis == model::Basis::full || elastic.n_q() == 0) return 0;
  const Eigen::ArrayXd amplitude = per_length.segment(body.first + body.n_open(), body.eq.n_q()).array();
  return (elastic.K_r.diagonal().array() * amplitude.square()).minCoeff();
}

// Tolerated energy norm of the local error of each body's elastic coordinates, Eq. (8.9a).
Eigen::VectorXd tolerated_stress(Run& run) {
  const StepControl& control = run.control;
  const double share = kMostError * run.settings.step_error, least = kSmallDisplacement * control.size;
  Eigen::VectorXd tolerated = Eigen::VectorXd::Zero(control.stiffness.size());
  for (Eigen::Index b = 0; b < tolerated.size(); ++b) {
    if (control.stiffness[b] == 0) continue;
    const auto i = static_cast<std::size_t>(b);
    const model::ElasticBody& body = *run.problem.system.bodies()[i].eq.body;
    const model::BodyState& state = run.last->bodies[i];
    const double twice_energy = state.q.dot(body.K_r * state.q) + state.q_dot.dot(body.M_r * state.q_dot) +
                                2 * run.problem.system.residual_energy(i);
    tolerated[b] = share * std::sqrt(twice_energy + control.stiffness[b] * least * least);
  }
  return tolerated;
}

// Largest energy norm of an error of a body's elastic coordinates over the tolerated one.
double stress_error(const Run& run, ConstVector error) {
  double largest = 0;
  for (std::size_t b = 0; b < run.problem.system.bodies().size(); ++b) {
    const double tolerated = run.control.stress[static_cast<Eigen::Index>(b)];
    if (tolerated == 0) continue;
    const System::Body& body = run.problem.system.bodies()[b];
    const auto q = error.segment(body.first + body.n_open(), body.eq.n_q());
    largest = std::max(largest, std::sqrt(q.dot(body.eq.body->K_r * q)) / tolerated);
  }
  return largest;
}

// Corners of a box around the surface of a body, 3 x 8, or without columns.
Eigen::Matrix3Xd corners_around(const model::Surface& surface) {
  const Eigen::Matrix3Xd& X = surface.X;
  if (X.cols() == 0) return Eigen::Matrix3Xd(3, 0);
  const Eigen::Vector3d low = X.rowwise().minCoeff(), high = X.rowwise().maxCoeff();
  Eigen::Matrix3Xd corners(3, 8);
  for (int corner = 0; corner < 8; ++corner)
    for (int i = 0; i < 3; ++i) corners(i, corner) = corner & (1 << i) ? high[i] : low[i];
  return corners;
}

// Bound of the speed of a body's surface but for its vibration, m/s.
double surface_speed(const Run& run, std::size_t b, const State& x) {
  const body::Equations& eq = run.problem.system.bodies()[b].eq;
  const body::FrameMotion f = body::frame_motion(eq, run.problem.system.motion(b, x));
  double speed = 0;
  for (const auto& corner : run.control.corners[b].colwise())
    speed = std::max(speed, (f.v + f.w.cross(Eigen::Vector3d(corner))).norm());
  return speed;
}

// The step in which surfaces of a pair go by as far as the contact depth, within which alone they see each
// other, s.
double longest_step(const Run& run, const State& x) {
  const System& system = run.problem.system;
  double step = std::numeric_limits<double>::infinity();
  for (std::size_t p = 0; p < system.pairs().size(); ++p) {
    double speed = 0;
    for (int b : system.pairs()[p].body) speed += surface_speed(run, static_cast<std::size_t>(b), x);
    if (speed > 0) step = std::min(step, system.contact_settings(p).depth / speed);
  }
  return step;
}

// Equal steps that end at the next time of output, none longer than `longest` and about as long as dt, s.
double step_to_output(const Run& run, double time, double dt, double longest) {
  constexpr double kLonger = 1.15;  // than dt, for the sake of fewer steps
  const double left = next_output(run, time) - time;
  if (!std::isfinite(left)) return std::min(dt, longest);
  return left / std::ceil(left / std::min(kLonger * dt, longest));
}

// J, that contact would store in the present state, static responses included.
double contact_energy(System& system, double t, ConstVector U, ConstVector V) {
  double energy = stored_in_contact(system.contacts(t, U, V));
  for (std::size_t b = 0; b < system.bodies().size(); ++b) energy += system.residual_energy(b);
  return energy;
}

// The step of the first touch sees no contact before its end, so that what contact then stores, Eq. (8.9b),
// is work that nothing has done.
PetscErrorCode accept_touch(TSAdapt, TS ts, PetscReal t, Vec U, PetscBool* accept) {
  Run* run = nullptr;
  PetscCall(TSGetApplicationContext(ts, &run));
  return guard(run->problem.pending, [&] {
    PetscReal dt = 0;
    check(TSGetTimeStep(ts, &dt));
    if (run->touches || dt <= kShortestStep * run->nominal_dt) return;
    System& system = run->problem.system;
    const Eigen::VectorXd V = Eigen::VectorXd::Zero(system.size());  // without influence on the depth
    const ReadView u(U);
    const double allowed = kTouchEnergy * run->settings.step_error * run->energy;
    if (system.depth_share(t, *u, V) > kFirstTouch || contact_energy(system, t, *u, V) > allowed)
      *accept = PETSC_FALSE;
  });
}

// Errors scatter from step to step: one that is little larger than tolerated is not worth another trial.
void aim_below_most(TSAdapt adapt) {
  check(TSAdaptSetSafety(adapt, kSafety / std::cbrt(kMostError), PETSC_DEFAULT));
}

// Forces are balanced no more closely than the error of steps is worth.
void balance_by_error(const Run& run, TS ts) {
  SNES snes = nullptr;
  check(TSGetSNES(ts, &snes));
  check(SNESSetTolerances(snes, PETSC_DEFAULT, unbalanced_at(run.settings.step_error), PETSC_DEFAULT,
                          PETSC_DEFAULT, PETSC_DEFAULT));
}

Eigen::VectorXd coordinates_per_length(const System& system) {
  Eigen::VectorXd scale(system.size());
  for (const System::Body& body : system.bodies()) {
    for (Eigen::Index i = 0; i < body.n_open(); ++i) {
      const bool angle = body::is_angle(body.eq.joint.type, body.open[static_cast<std::size_t>(i)]);
      scale[body.first + i] = angle ? 1 / reach(body) : 1;
    }
    scale.segment(body.first + body.n_open(), body.eq.n_q()) = amplitudes(*body.eq.body);
  }
  return scale;
}

}  // namespace

double first_step(const Run& run) {
  return std::min(kFirstStep * advise(run.problem.system).step(), kFirstShare * run.settings.end_time);
}

void control_steps(Run& run, TS ts) {
  if (!are_steps_chosen(run.settings)) return;
  TSAdapt adapt = nullptr;
  check(TSGetAdapt(ts, &adapt));
  check(TSAdaptSetType(adapt, TSADAPTBASIC));
  check(TSAdaptSetCheckStage(adapt, accept_touch));
  check(TSAdaptSetClip(adapt, kMostCut, kMostGrowth));
  if (has_step_error(run.settings)) {
    aim_below_most(adapt);
    balance_by_error(run, ts);
  }
  run.control.per_length = coordinates_per_length(run.problem.system);
  for (const System::Body& body : run.problem.system.bodies()) {
    run.control.size = std::max(run.control.size, reach(body));
    run.control.corners.push_back(corners_around(body.eq.body->surface));
  }
}

void measure_stress(Run& run, TS ts) {
  if (!has_step_error(run.settings)) return;
  const std::vector<System::Body>& bodies = run.problem.system.bodies();
  run.control.stress = run.control.stiffness =
      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(bodies.size()));
  for (std::size_t b = 0; b < bodies.size(); ++b)
    run.control.stiffness[static_cast<Eigen::Index>(b)] = softest(bodies[b], run.control.per_length);
  generalized_alpha_set_measure(ts, [&run](Vec error, PetscReal* norm) {
    *norm = stress_error(run, *ReadView(error));
    return PetscErrorCode(0);
  });
}

void set_force_tolerance(Run& run, TS ts) {
  SNES snes = nullptr;
  PetscReal unbalanced = 0;
  check(TSGetSNES(ts, &snes));
  check(SNESGetTolerances(snes, nullptr, &unbalanced, nullptr, nullptr, nullptr));
  run.problem.system.set_force_tolerance(has_step_error(run.settings) ? unbalanced : 0);
}

void follow_displacement(Run& run) {
  if (run.control.per_length.size() == 0) return;
  run.control.displacement = elastic_displacement(run);
  if (has_step_error(run.settings)) run.control.stress = tolerated_stress(run);
}

void limit_steps(Run& run, TS ts) {
  StepControl& control = run.control;
  if (control.per_length.size() == 0) return;
  const double length = tolerance(run);
  if (length != run.summary.step_tolerance)
    generalized_alpha_set_tolerances(ts, vector(control.per_length), length, run.settings.velocity_tolerance);
  run.summary.step_tolerance = length;
  Vec U = nullptr, V = nullptr;
  PetscReal time = 0, dt = 0, shortest = 0, longest = 0;
  TSAdapt adapt = nullptr;
  check(TSGetTime(ts, &time));
  check(TSGetTimeStep(ts, &dt));
  check(TS2GetSolution(ts, &U, &V));
  check(TSGetAdapt(ts, &adapt));
  check(TSAdaptGetStepLimits(adapt, &shortest, &longest));
  if (control.longest_step == 0) control.longest_step = longest;
  const ReadView u(U), v(V);
  longest = std::min(control.longest_step, longest_step(run, {time, *u, *v, *v}));
  check(TSAdaptSetStepLimits(adapt, std::min(shortest, longest), longest));
  const double next = step_to_output(run, time, dt, longest);
  if (next != dt) check(TSSetTimeStep(ts, next));
}

}  // namespace elastogear::dynamics
