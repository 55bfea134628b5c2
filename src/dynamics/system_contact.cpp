#include "dynamics/system_contact.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "dynamics/contact/node_mobility.h"
#include "elastogear/base/error.h"
#include "elastogear/contact/stiffness.h"

namespace elastogear::dynamics {
namespace {

constexpr int kFreeTrials = 3;  // of contact forces before points that open and close by turns are kept

// Those of a system touch at stations together, as their forces depend on each other.
bool uses_stations(const SystemModel& model) {
  return !model.pairs.empty() && model.pairs.front().settings.points == contact::SlavePoints::stations;
}

// Vectorised, which == is not.
bool same(const Eigen::VectorXd& a, ConstVector b) {
  return a.size() == b.size() && (a - b).cwiseAbs().sum() == 0;
}

// N, norm of the forces that the roundoff of positions makes on the penalty stiffness of a pair.
double roundoff_force(const contact::Pair& pair) {
  double length = 0, stiffness = 0;
  if (pair.settings().law != contact::ContactLaw::penalty) return 0;
  for (int side : {0, 1}) {
    const model::Surface& surface = pair.surface(side);
    length += surface.X.cwiseAbs().maxCoeff();
    stiffness = std::max(stiffness, contact::node_stiffness(pair.settings(), surface).norm());
  }
  return std::numeric_limits<double>::epsilon() * length * stiffness;
}

}  // namespace

SystemContact::SystemContact(const SystemModel& model, const SystemContact* like)
    : pairs_(model.pairs), residual_contact_(model) {
  for (const SystemModel::Body& body : model.bodies)
    surface_.push_back(body.in_contact ? &body.eq.body->surface : nullptr);
  if (like)
    copy_detectors(*like);
  else
    for (const PairSetup& pair : pairs_) make_detector(model, pair);
  if (uses_stations(model)) stations_.emplace(model);
  unilateral_ = is_unilateral();
  double roundoff = 0;
  for (const contact::Pair& pair : detectors_) roundoff += roundoff_force(pair);
  residual_contact_.expect_roundoff(roundoff);
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    residual_contact_.set_creep(b, model.bodies[b].relaxed);
}

void SystemContact::make_detector(const SystemModel& model, const PairSetup& pair) {
  const SystemModel::Body &a = model.bodies[pair.body[0]], &b = model.bodies[pair.body[1]];
  detectors_.emplace_back(a.eq.body->surface, b.eq.body->surface, pair.settings,
                          std::array{&a.eq.body->K_r, &b.eq.body->K_r},
                          std::array{a.true_surface.get(), b.true_surface.get()},
                          std::array{responding_nodes(*a.eq.body), responding_nodes(*b.eq.body)});
  detectors_.back().follow_points();
  if (pair.settings.law != contact::ContactLaw::augmented) return;
  for (int side : {0, 1}) detectors_.back().set_masses(side, node_masses(*(side == 0 ? a : b).eq.body));
}

void SystemContact::copy_detectors(const SystemContact& like) {
  require(surface_ == like.surface_ && pairs_.size() == like.pairs_.size(),
          "internal: the contact of other bodies");
  for (const contact::Pair& detector : like.detectors_) detectors_.emplace_back(detector);
}

// Tells whether forces are solved for together with static responses. All pairs of bodies with residual
// flexibility must have the same law, for which the static responses are found.
bool SystemContact::is_unilateral() const {
  const PairSetup *unilateral = nullptr, *penalty = nullptr;
  for (const PairSetup& pair : pairs_) {
    const bool flexible =
        residual_contact_.has_flexibility(pair.body[0]) || residual_contact_.has_flexibility(pair.body[1]);
    if (pair.settings.law == contact::ContactLaw::unilateral)
      unilateral = &pair;
    else if (flexible)
      penalty = &pair;
  }
  require(!unilateral || !penalty, "pairs ", unilateral ? unilateral->name : "", " and ",
          penalty ? penalty->name : "",
          ": one has the contact law unilateral, the other penalty; give both the same");
  return unilateral != nullptr;
}

const ContactState* SystemContact::known(double time, ConstVector U, ConstVector V,
                                         ForceAccuracy accuracy) const {
  const bool is_exact = accuracy_ == ForceAccuracy::balanced || accuracy == ForceAccuracy::observed;
  return U_ && is_exact && time == time_ && same(*U_, U) && same(V_, V) ? &state_ : nullptr;
}

// Do forces of an accepted state stay in later ones?
bool SystemContact::remembers_forces() const {
  for (std::size_t p = 0; p < pairs_.size(); ++p)
    if (has_friction(p, contact::FrictionLaw::stick)) return true;
  for (std::size_t b = 0; b < surface_.size(); ++b)
    if (residual_contact_.creeps(b)) return true;
  return false;
}

const ContactState& SystemContact::evaluate(double time, ConstVector U, ConstVector V,
                                            const std::vector<contact::SurfaceMotion>& motion,
                                            ForceAccuracy accuracy) {
  accuracy_ = remembers_forces() ? ForceAccuracy::balanced : accuracy;
  forget();
  place(motion);
  if (stations_) {
    stations_->evaluate(motion, residual_contact_, state_);
    U_ = U;
    V_ = V;
    time_ = time;
    return state_;
  }
  if (residual_contact_.any() && time != time_) residual_contact_.predict(time);
  if (time != time_ && !follows_) release_points();
  for (contact::Pair& pair : detectors_) pair.follow_far(follows_);
  detect(motion);
  if (unilateral_ || residual_contact_.any()) solve(motion);
  U_ = U;
  V_ = V;
  time_ = time;
  return state_;
}

void SystemContact::solve(const std::vector<contact::SurfaceMotion>& motion) {
  if (!unilateral_) return residual_contact_.solve(state_, [&] { detect(motion); });
  int trial = 0;
  residual_contact_.solve_unilateral(state_, accuracy_, [&] {
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
      detectors_[p].set_forces(state_.pair[p].points);
      if (trial >= kFreeTrials) detectors_[p].keep_minima(state_.pair[p].points);
    }
    ++trial;
    detect(motion);
  });
  for (std::size_t p = 0; p < pairs_.size(); ++p)
    if (!has_friction(p, contact::FrictionLaw::stick)) detectors_[p].set_forces(state_.pair[p].points);
}

// Sets the placements of the bodies; surfaces are undeformed at first.
void SystemContact::place(const std::vector<contact::SurfaceMotion>& motion) {
  state_.surface.resize(motion.size());
  for (std::size_t b = 0; b < motion.size(); ++b) {
    contact::SurfaceState& surface = state_.surface[b];
    if (surface.x_B.cols() == 0 && surface_[b]) surface.x_B = surface_[b]->X;
    surface.r_WB = motion[b].r_WB;
    surface.R_WB = motion[b].R_WB;
  }
}

// Detects the contacts of the bodies with the residual displacements of the last trial.
void SystemContact::detect(const std::vector<contact::SurfaceMotion>& motion) {
  state_.pair.clear();
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    const int a = pairs_[p].body[0], b = pairs_[p].body[1];
    const std::array<contact::ResidualDisplacement, 2> residual{residual_contact_.residual(a),
                                                                residual_contact_.residual(b)};
    state_.pair.push_back({{a, b}, detectors_[p].detect(motion[a], motion[b], residual)});
    place_touched(p);
  }
  residual_contact_.seen();
  state_.force = nodal_forces(state_.pair, state_.surface);
}

// Sets the positions of the nodes that contact touches; those of the others stay undeformed.
void SystemContact::place_touched(std::size_t p) {
  const PairContacts& pair = state_.pair[p];
  for (const contact::ContactPoint& point : pair.points)
    for (int i = 0; i < point.n_local(); ++i) {
      const auto [side, node] = local_node(point, i);
      state_.surface[pair.body[side]].x_B.col(node) = detectors_[p].position(side, node);
    }
}

bool SystemContact::any_augmented() const {
  return std::any_of(pairs_.begin(), pairs_.end(), [](const PairSetup& pair) {
    return pair.settings.law == contact::ContactLaw::augmented;
  });
}

double SystemContact::unclosed() const {
  double most = 0;
  for (std::size_t p = 0; p < pairs_.size(); ++p)
    if (is_augmented(p))
      most = std::max(most, detectors_[p].unclosed(state_.pair[p].points) / settings(p).depth);
  return most;
}

void SystemContact::augment() { set_forces(std::exchange(state_.pair, {})); }

void SystemContact::stiffen(double factor) {
  for (std::size_t p = 0; p < pairs_.size(); ++p)
    if (is_augmented(p)) detectors_[p].stiffen(factor);
  forget();
}

void SystemContact::set_forces(const std::vector<PairContacts>& pairs) {
  for (std::size_t p = 0; p < pairs_.size(); ++p)
    if (is_augmented(p)) detectors_[p].set_forces(pairs[p].points);
  forget();
}

void SystemContact::begin_step(double dt, double alpha_f) {
  for (std::size_t p = 0; p < pairs_.size(); ++p)
    if (is_augmented(p)) detectors_[p].begin_step({dt, alpha_f});
  forget();
}

bool SystemContact::change_closed() {
  bool changed = false;
  for (std::size_t p = 0; p < pairs_.size(); ++p)
    changed |= is_augmented(p) && detectors_[p].change_closed(state_.pair[p].points);
  if (changed) forget();
  return changed;
}

void SystemContact::end_step(bool solved, double delivered) {
  bool impulse = false;
  for (std::size_t p = 0; p < pairs_.size(); ++p)
    if (is_augmented(p))
      impulse |= detectors_[p].end_step(solved ? &state_.pair[p].points : nullptr, delivered);
  if (solved) history_.impulse_before = std::exchange(history_.impulse, impulse);
  forget();
}

double SystemContact::depth_share() const {
  double share = 0;
  for (std::size_t p = 0; p < pairs_.size(); ++p)
    for (const contact::ContactPoint& point : state_.pair[p].points)
      share = std::max(share, -point.g_n / settings(p).depth);
  return share;
}

bool SystemContact::has_friction(std::size_t p, contact::FrictionLaw law) const {
  const contact::FrictionSettings& friction = pairs_[p].settings.friction;
  return friction.mu > 0 && friction.law == law;
}

// Energy that regularised friction takes as static responses change, in J since the last accepted state. The
// slip velocity does not contain that change. docs/theory, Eq. (7.2a).
double SystemContact::friction_loss_of_responses() {
  if (!residual_contact_.any()) return 0;
  std::vector<PairContacts> rubbing;
  for (std::size_t p = 0; p < pairs_.size(); ++p)
    if (has_friction(p, contact::FrictionLaw::regularised)) rubbing.push_back(state_.pair[p]);
  if (rubbing.empty()) return 0;
  const std::vector<NodalForces> then = std::exchange(
      history_.friction, stations_ ? state_.stations.friction : friction_forces(rubbing, state_.surface));
  return then.empty() ? 0 : -residual_contact_.work(then, history_.friction);
}

void SystemContact::begin_equilibrium_search(double tolerance) {
  residual_contact_.ask_forces(0);
  if (remembers_forces()) return;
  if (residual_contact_.begin_equilibrium_search(tolerance)) forget();
}

bool SystemContact::release_points() {
  bool any = false;
  for (contact::Pair& pair : detectors_) {
    any |= pair.release_minima();
    pair.look_at_all();
  }
  if (any) forget();
  return any;
}

void SystemContact::accept() {
  double power = 0;
  bool any_sticks = false;
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    const bool sticks = has_friction(p, contact::FrictionLaw::stick);
    any_sticks |= sticks;
    for (const contact::ContactPoint& point : state_.pair[p].points) {
      history_.loss += point.work;
      power += point.power + (sticks ? 0 : point.friction_power);
    }
    if (!stations_) detectors_[p].accept(state_.pair[p].points);
  }
  history_.loss += friction_loss_of_responses();
  if (history_.accepted) history_.loss += 0.5 * (time_ - history_.time) * (power + history_.power);
  history_.accepted = true;
  history_.time = time_;
  history_.power = power;
  if (residual_contact_.any()) residual_contact_.accept(time_);
  if (any_sticks) forget();  // forces of the same state start from the new history
}

void SystemContact::serialize(Archive& archive) {
  archive(history_.accepted);
  archive(history_.impulse);
  archive(history_.impulse_before);
  for (double* x : {&history_.time, &history_.power, &history_.loss}) archive(*x);
  archive.each(history_.friction, [&](NodalForces& forces) {
    archive(forces.node);
    archive(forces.f_B);
  });
  for (contact::Pair& pair : detectors_) pair.serialize(archive);
  residual_contact_.serialize(archive);
  if (archive.is_loading()) forget();
}

}  // namespace elastogear::dynamics
