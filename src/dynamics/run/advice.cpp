#include "elastogear/dynamics/advice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>
#include <utility>

#include "dynamics/contact/node_mobility.h"
#include "elastogear/contact/stiffness.h"

namespace elastogear::dynamics {
namespace {

constexpr double kStepsPerPeriod = 10;
constexpr double kLargestGradient = 0.05;  // elastic rotation (rad) and strain: second-order terms reach 5 %
constexpr double kLargestSpeed = 0.1;      // of the lowest mode: centrifugal softening of its stiffness, 1 %
constexpr double kLargestLoss = 0.01;      // of a frequency: Coriolis forces that the inertia leaves out
constexpr int kStates = 50;                // in which a force is looked at, if it turns kTurns times in them
constexpr int kTurns = 10;                 // five periods; of fifty states: a period has ten at most
constexpr double kChange = 0.7;         // of the force, from state to state or from turn to turn, in the mean
constexpr double kResolved = 0.5;       // of the highest mode's frequency: vibrations of several modes
constexpr double kLargestShare = 0.05;  // of the contact forces, on nodes without a static response

void raise(Vibration& to, const std::string& name, double frequency) {
  if (frequency > to.frequency) to = {name, frequency};
}

// Hz, up to which the modes of the bodies of pair p vibrate: of the body whose modes end first.
double highest_mode(const System& system, std::size_t p) {
  double highest = std::numeric_limits<double>::infinity();
  for (int b : system.pairs()[p].body) {
    const model::ElasticBody& body = *system.bodies()[b].eq.body;
    if (body.frequency.size() > 0)
      highest = std::min(highest, body.frequency.head(body.n_modes()).maxCoeff());
  }
  return highest;
}

double contact_frequency(const System& system, std::size_t p) {
  const contact::Settings& settings = system.contact_settings(p);
  if (settings.law != contact::ContactLaw::penalty) return 0;  // nothing vibrates on its stiffness
  double rate = 0;
  for (int b : system.pairs()[p].body) {
    const model::ElasticBody& body = *system.bodies()[b].eq.body;
    rate = std::max(
        rate,
        contact::node_stiffness(settings, body.surface).cwiseProduct(elastic_mobility(body)).maxCoeff());
  }
  return std::sqrt(rate) / (2 * std::numbers::pi);
}

// s: the speed of rotation times this bounds by how much of itself any frequency is off for the Coriolis
// forces that the level leaves out, Eq. (8.18a).
double lost_coriolis(const body::Equations& eq) {
  const Eigen::VectorXd& frequency = eq.body->frequency;
  if (frequency.size() == 0 || eq.level == body::InertiaLevel::full) return 0;
  Eigen::ArrayXd lost = Eigen::ArrayXd::Ones(frequency.size());
  if (eq.level == body::InertiaLevel::affine) lost -= eq.affine.Y.rowwise().squaredNorm().array();
  return std::max(0., (lost / (2 * std::numbers::pi * frequency.array())).maxCoeff());
}

// Share of the contact forces that acts on nodes without a static response, of a body that has some; -.
double share_without_response(const model::ElasticBody& body, const model::ContactForces& contact) {
  if (body.flexibility.empty()) return 0;
  double without = 0, all = 0;
  for (std::size_t i = 0; i < contact.node.size(); ++i) {
    const double f = contact.f_B.col(static_cast<Eigen::Index>(i)).norm();
    all += f;
    if (model::find_loaded(body.flexibility, contact.node[i]) < 0) without += f;
  }
  return without > 0 ? without / all : 0;
}

std::string sentence(const std::string& who, double time, double value, const char* meaning) {
  std::ostringstream text;
  text.precision(3);
  text << who << " at t = " << time << " s: " << meaning << " " << value;
  return text.str();
}

}  // namespace

double Vibration::step() const {
  return frequency > 0 ? 1 / (kStepsPerPeriod * frequency) : std::numeric_limits<double>::infinity();
}

double Advice::step() const { return std::min(mode.step(), contact.step()); }

Advice advise(const System& system) {
  Advice advice;
  for (const System::Body& body : system.bodies())
    if (const model::ElasticBody& elastic = *body.eq.body; elastic.frequency.size() > 0)
      raise(advice.mode, body.name, elastic.frequency.head(elastic.n_modes()).maxCoeff());
  for (std::size_t p = 0; p < system.pairs().size(); ++p)
    raise(advice.contact, system.pairs()[p].name, contact_frequency(system, p));
  return advice;
}

ValidityGuard::ValidityGuard(const System& system, double dt)
    : system_(&system), dt_(dt), too_fast_(system.pairs().size(), false) {
  for (const System::Body& body : system.bodies()) {
    const model::Surface& surface = body.eq.body->surface;
    Watch watch{DeformationWatch(*body.eq.body)};
    const Eigen::VectorXd& frequency = body.eq.body->frequency;
    if (frequency.size() > 0) watch.lowest_mode = 2 * std::numbers::pi * frequency.minCoeff();
    watch.lost_coriolis = lost_coriolis(body.eq);
    if (surface.X.cols() > 0) watch.radius = std::sqrt(surface.X.colwise().squaredNorm().maxCoeff());
    watch_.push_back(std::move(watch));
  }
}

// Bound of the speed of its surface but for the vibration, m/s.
double ValidityGuard::surface_speed(std::size_t b, const model::BodyState& state) const {
  const body::Equations& eq = system_->bodies()[b].eq;
  const body::FrameMotion f = body::frame_motion(eq.joint, eq.H, {state.s, state.s_dot, state.s_ddot});
  return f.v.norm() + f.w.norm() * watch_[b].radius;
}

void ValidityGuard::watch_body(std::size_t b, const model::Snapshot& snapshot, Warnings& said) {
  const System::Body& body = system_->bodies()[b];
  const model::BodyState& state = snapshot.bodies[b];
  const std::string who = "body '" + body.name + "'";
  Watch& watch = watch_[b];
  const double bent = watch.deformed ? 0 : watch.deformation.largest(state.q, kLargestGradient);
  const double speed =
      body::frame_motion(body.eq.joint, body.eq.H, {state.s, state.s_dot, state.s_ddot}).w.norm();
  if (bent > kLargestGradient) {
    watch.deformed = true;
    said.push_back(
        sentence(who, snapshot.time, bent,
                 "elastic rotation or strain is no longer small, the equations are linear in it:"));
  }
  if (!watch.fast && watch.lowest_mode > 0 && speed > kLargestSpeed * watch.lowest_mode) {
    watch.fast = true;
    said.push_back(
        sentence(who, snapshot.time, speed / watch.lowest_mode,
                 "turns too fast to leave out how rotation changes the stiffness; speed over that of the "
                 "lowest mode:"));
  }
  if (!watch.too_coarse && speed * watch.lost_coriolis > kLargestLoss) {
    watch.too_coarse = true;
    said.push_back(sentence(who, snapshot.time, speed * watch.lost_coriolis,
                            "its inertia level leaves out Coriolis forces of the deformation, which "
                            "split and shift frequencies; take -inertia full, of a body file made by "
                            "reduce -invariants full; a frequency is off by at most this share of itself:"));
  }
  const double share = watch.beside_loaded ? 0 : share_without_response(*body.eq.body, state.contact);
  if (share > kLargestShare) {
    watch.beside_loaded = true;
    said.push_back(
        sentence(who, snapshot.time, share,
                 "contact acts on nodes without a static response, where the body is too stiff and "
                 "its stresses are wrong: reduce it again with them among -loaded; share of the "
                 "contact forces:"));
  }
}

void ValidityGuard::watch_pair(std::size_t p, const model::Snapshot& snapshot, Warnings& said) {
  double distance = 0;
  for (int b : system_->pairs()[p].body) distance += dt_ * surface_speed(b, snapshot.bodies[b]);
  const double share = distance / system_->contact_settings(p).depth;
  if (too_fast_[p] || share <= 1) return;
  too_fast_[p] = true;
  said.push_back(sentence("pair " + system_->pairs()[p].name, snapshot.time, share,
                          "surfaces may pass through each other unseen; take a smaller -ts_dt or a larger "
                          "-contact_depth; distance in a step over the contact depth:"));
}

std::vector<std::string> ValidityGuard::warnings(const model::Snapshot& snapshot) {
  Warnings said;
  for (std::size_t b = 0; b < watch_.size(); ++b) watch_body(b, snapshot, said);
  for (std::size_t p = 0; p < too_fast_.size(); ++p) watch_pair(p, snapshot, said);
  return said;
}

ChatterWatch::ChatterWatch(const System& system) : system_(&system), force_(system.pairs().size()) {
  for (std::size_t p = 0; p < force_.size(); ++p) {
    force_[p].watched = system.contact_settings(p).law == contact::ContactLaw::unilateral;
    force_[p].highest_mode = highest_mode(system, p);
  }
}

// Enters the force of a state. Returns what it did at the end of a window, or nothing.
std::string ChatterWatch::unsteady(Force& force, double time, double now) {
  if (force.states == 0) force.begin = time;
  const double change = now - std::exchange(force.last, now);
  if (change != 0 && std::exchange(force.change, change) * change < 0) ++force.turns;
  force.sum += now;
  force.changes += std::abs(change);
  if (++force.states < kStates || force.turns < kTurns) return {};
  const Force window = std::exchange(force, {force.watched, force.highest_mode, 0, now, change});
  const double mean = window.sum / window.states, frequency = window.turns / 2.0 / (time - window.begin);
  if (window.changes > kChange * window.sum && window.turns > kTurns)
    return "chatters: its force rises and falls from output to output, so that force and energy are wrong";
  if (window.changes < kChange * mean * window.turns || frequency < kResolved * window.highest_mode)
    return {};
  std::ostringstream text;
  text.precision(3);
  text << "its force vibrates at " << frequency << " Hz, beside modes of at most " << window.highest_mode
       << " Hz: a shock has more than these modes; the mean of the force is right, its peaks are not";
  return text.str();
}

std::vector<std::string> ChatterWatch::warnings(const model::Snapshot& snapshot) {
  std::vector<std::string> said;
  for (std::size_t p = 0; p < force_.size(); ++p) {
    if (!force_[p].watched) continue;
    const std::string what = unsteady(force_[p], snapshot.time, snapshot.pairs[p].force.norm());
    if (what.empty()) continue;
    force_[p].watched = false;
    std::ostringstream text;
    text.precision(3);
    text << "contact " << system_->pairs()[p].name << " at t = " << snapshot.time << " s: " << what
         << ". Give the bodies damping (-<body>_damping_ratio), take a penalty (-contact_law penalty; bodies "
            "that begin in contact may need -contact_offset 1e-7), or write more outputs (-output_dt)";
    said.push_back(text.str());
  }
  return said;
}

}  // namespace elastogear::dynamics
