#include "elastogear/dynamics/sweep.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "dynamics/equilibrium/equilibrium.h"
#include "dynamics/integrator/vec_view.h"
#include "dynamics/run/run.h"
#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"
#include "elastogear/dynamics/static.h"

namespace elastogear::dynamics {
namespace {

// Times of a system that sweeps: loads grow until 1, positions follow from there.
constexpr double kLoaded = 1;
constexpr int kMostToGoOn = 40;        // iterations from one position to the next
constexpr int kMostToLoad = 40;        // iterations in a load step
constexpr double kLeastStep = 0.1;     // of the load, of the first attempt, and of the load steps of others
constexpr double kBefore = 0.25;       // of the way between positions, before one that is not found
constexpr double kLargeJump = 1e-3;    // share of the forces that may be unbalanced where all else fails
constexpr double kUsualWay = 1 / 32.;  // where there is one position only
constexpr double kLastValue = std::numeric_limits<double>::infinity();

bool turns(const BodySetup& setup) {
  return setup.joint.type == body::JointType::free || body::has_rotation_axis(setup.joint.type);
}

// The setup at a position, with loads that grow until kLoaded.
BodySetup at_position(BodySetup setup, double rate, double position) {
  const std::optional<Drive> drive = std::exchange(setup.rotation.drive, {});
  scale_by_load_factor(setup, kLastValue);
  const double turned = rate * position;
  if (setup.joint.type == body::JointType::free)
    setup.joint.R_WB0 *= rotation_matrix({0, 0, turned});
  else if (drive)
    setup.rotation.drive = still_drive(at(*drive, 0).s + turned, rate, kLoaded);
  else if (turns(setup))
    setup.rotation.s_0 += turned;
  return setup;
}

SystemModel model_at(const SlowMotion& motion, double position) {
  std::vector<BodySetup> bodies;
  for (std::size_t b = 0; b < motion.bodies.size(); ++b)
    bodies.push_back(at_position(motion.bodies[b], motion.rate[b], position));
  MarkerSetups markers = motion.markers;
  scale_by_load_factor(markers, kLastValue);
  Environment environment = motion.environment;
  scale_by_load_factor(environment);
  return make_system_model(bodies, motion.pairs, environment, markers);
}

// Rates of the joint coordinates of all bodies, in units of the position.
std::vector<Eigen::VectorXd> sliding(const SlowMotion& motion, const System& system) {
  std::vector<Eigen::VectorXd> rates;
  for (std::size_t b = 0; b < motion.rate.size(); ++b) {
    const body::Joint& joint = system.bodies()[b].eq.joint;
    rates.push_back(Eigen::VectorXd::Zero(system.bodies()[b].eq.n_s()));
    if (joint.type == body::JointType::free)
      rates.back()[5] = motion.rate[b];
    else if (body::has_rotation_axis(joint.type))
      rates.back()[0] = motion.rate[b];
  }
  return rates;
}

// A system that is led from position to position, from the one at which it was loaded.
struct Sweep {
  Sweep(const SlowMotion& m, const System& like, double p, const std::function<bool()>& stop)
      : motion(m),
        system(model_at(m, p), like),
        sanity(system),
        at(system),
        snes(make_snes(at, J)),
        first(p) {
    system.set_sliding(sliding(motion, system));
    request_stop(at, stop);
  }

  const SlowMotion& motion;
  System system;
  Sanity sanity;
  Equilibrium at;
  UniqueMat J;
  UniqueSNES snes;
  double first, position = first;
  Eigen::VectorXd U = {};  // the last equilibrium
};

// The option -snes_max_it wins.
void limit_iterations(const Sweep& sweep, int most) {
  PetscBool given = PETSC_FALSE;
  check(PetscOptionsHasName(nullptr, nullptr, "-snes_max_it", &given));
  if (given) return;
  check(SNESSetTolerances(sweep.snes, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT, most,
                          std::numeric_limits<PetscInt>::max()));
}

// Finds the equilibrium at the first position; Error where there is none.
void load(Sweep& sweep, int steps, RunSummary& summary) {
  require_bodies_apart(sweep.system);
  LoadPath path(sweep.system, steps);
  path.least_step = kLeastStep * std::min(1.0, 2.0 / steps);
  limit_iterations(sweep, kMostToLoad);
  sweep.at.begins_near = false;
  while (path.reached < 1) advance(sweep.at, sweep.snes, path, summary);
  sweep.U = path.good;
}

// All bodies turned on with their rate.
Eigen::VectorXd turned_on(const Sweep& sweep, double by) {
  Eigen::VectorXd U = sweep.U;
  for (std::size_t b = 0; b < sweep.motion.rate.size(); ++b) {
    const System::Body& body = sweep.system.bodies()[b];
    const double angle = sweep.motion.rate[b] * by;
    if (body.eq.joint.type == body::JointType::free)
      U[body.first + 5] += 2 * std::tan(angle / 2);  // of Cayley's vector, which is zero in x and y
    else if (body::has_rotation_axis(body.eq.joint.type) && !body.axis[0].drive)
      U[body.first] += angle;
  }
  return U;
}

// Goes on to a position; false where Newton's method does not lead there.
bool go_on(Sweep& sweep, double position, RunSummary& summary) {
  const double by = position - sweep.position;
  for (std::size_t i = 0; i < sweep.motion.bushing_rate.size(); ++i)
    sweep.system.turn_bushing(i, sweep.motion.bushing_rate[i] * by);
  limit_iterations(sweep, kMostToGoOn);
  sweep.at.begins_near = true;
  sweep.at.factor = kLoaded + position - sweep.first;
  const UniqueVec U = vector(turned_on(sweep, by));
  if (!find_equilibrium(sweep.at, sweep.snes, U, summary)) return false;
  sweep.U = *ReadView(U);
  sweep.position = position;
  return true;
}

// J, by which the turning ends of bushings have brought in energy, trapezoidal.
double work_of_turning(const SlowMotion& motion, const model::Snapshot& before, const model::Snapshot& now) {
  double work = 0;
  for (std::size_t i = 0; i < motion.bushing_rate.size(); ++i) {
    const Eigen::Vector3d axis = motion.markers.bushings[i].axes.col(2);
    const Eigen::Vector3d torque = before.bushings[i].torque + now.bushings[i].torque;
    work += 0.5 * torque.dot(axis) * motion.bushing_rate[i] * (now.time - before.time);
  }
  return work;
}

double friction_power(const model::Snapshot& x) {
  double power = 0;
  for (const model::PairState& pair : x.pairs) power += pair.total.friction_power;
  return power;
}

// Work and losses from the first equilibrium on, over all systems that were led.
struct SweepLedger {
  EnergyLedger ledger = {};
  double lost_before = 0;  // J, less what the present system says it has lost
  double turning = 0;      // J, of bushings
  model::Snapshot last = {};
};

// The position becomes the snapshot's time. first: is it the first one of its system?
void enter(SweepLedger& all, Sweep& sweep, bool first, model::Snapshot& found) {
  all.ledger.enter(sweep.system, found);  // with the system's own time, by which its loads grow
  found.time = sweep.position;
  if (!all.last.bodies.empty()) {
    all.turning += work_of_turning(sweep.motion, all.last, found);
    if (first)
      all.lost_before +=
          0.5 * (found.time - all.last.time) * (friction_power(all.last) + friction_power(found));
  }
  found.energy.dissipated += all.lost_before;
  found.energy.work += all.turning;
  found.energy.balance += all.lost_before - all.turning;
  all.last = found;
}

struct Leader {
  const SlowMotion& motion;
  const SweepSettings& settings;
  const std::function<bool()>& stop;
  std::shared_ptr<const System> prepared;
  std::unique_ptr<Sweep> sweep = nullptr;  // null: the last position was not found
  SweepSummary summary = {};
  SweepLedger ledger = {};
};

// Finds the equilibrium of a position from the unloaded state there, then by way of one shortly before it,
// then by more load steps; false where there is none.
bool load_anew(Leader& leader, double position) {
  const SweepSettings& settings = leader.settings;
  const auto& p = settings.positions;
  const double way = p.size() > 1 ? (p.back() - p.front()) / static_cast<double>(p.size() - 1) : kUsualWay;
  struct Attempt {
    double from;
    int steps;
    bool may_jump;
  };
  const std::vector<Attempt> attempts = {{position, settings.steps, false},
                                         {position - kBefore * way, settings.steps, true},
                                         {position - 2 * kBefore * way, settings.steps, true},
                                         {position, settings.more_steps, true}};
  std::string why;
  for (const Attempt& attempt : attempts) try {
      leader.sweep = std::make_unique<Sweep>(leader.motion, *leader.prepared, attempt.from, leader.stop);
      if (attempt.may_jump) leader.sweep->at.jump = kLargeJump;
      load(*leader.sweep, attempt.steps, leader.summary.run);
      if (attempt.from == position || go_on(*leader.sweep, position, leader.summary.run)) {
        leader.sweep->at.jump = Equilibrium::kUsualJump;
        return true;
      }
    } catch (const Error& error) {
      if (why.empty()) why = error.what();
    }
  leader.sweep.reset();
  leader.summary.missing.push_back({position, why});
  return false;
}

// Goes on from the last position; false where that leads nowhere.
bool is_led(Leader& leader, double position) {
  try {
    return leader.sweep && go_on(*leader.sweep, position, leader.summary.run);
  } catch (const Error&) {
    return false;
  }
}

// Finds the equilibrium of a position and enters it; false where there is none.
bool find(Leader& leader, double position, model::Snapshot& found) {
  RunSummary& run = leader.summary.run;
  const bool was_led = leader.sweep != nullptr;
  const double lost = was_led ? leader.sweep->system.contact_loss() : 0;
  const bool led = is_led(leader, position);
  if (!led) {
    leader.ledger.lost_before += lost;
    if (!load_anew(leader, position)) return false;
    if (was_led) {
      ++leader.summary.restarts;
      ++run.rejected_steps;
    }
  }
  Sweep& sweep = *leader.sweep;
  const State x = sweep.at.state(sweep.U);
  sweep.system.accept(x);
  found = snapshot(sweep.system, x);
  sweep.sanity.require_small(found);
  enter(leader.ledger, sweep, !led, found);
  sweep.system.rebase(sweep.U);
  ++run.steps;
  return true;
}

}  // namespace

std::shared_ptr<const System> prepare(const SlowMotion& motion) {
  return std::make_shared<const System>(model_at(motion, 0));
}

void validate(const SlowMotion& motion, const SweepSettings& settings) {
  require(!settings.positions.empty(), "a sweep needs at least one position");
  require(settings.steps >= 1 && settings.more_steps >= 1, "load steps must be at least 1");
  double before = settings.lead_in.value_or(-kLastValue);
  for (double position : settings.positions) {
    require(std::isfinite(position) && position > before, "positions of a sweep must ascend: ", position,
            " does not come after ", before);
    before = position;
  }
  require(motion.rate.size() == motion.bodies.size(), "internal: a rate is needed for each body of a sweep");
  require(motion.bushing_rate.empty() || motion.bushing_rate.size() == motion.markers.bushings.size(),
          "internal: a rate is needed for each bushing of a sweep");
  for (std::size_t b = 0; b < motion.bodies.size(); ++b)
    require(motion.rate[b] == 0 || turns(motion.bodies[b]), "body '", motion.bodies[b].name,
            "' turns in a sweep: its joint must be revolute, cylindrical or free");
  for (const PairSetup& pair : motion.pairs) {
    const contact::FrictionSettings& friction = pair.settings.friction;
    require(friction.mu == 0 || friction.law == contact::FrictionLaw::regularised, "contact pair '",
            pair.name, "': a sweep slides; its friction must be regularised, not stick");
  }
}

SweepSummary sweep(const SlowMotion& motion, const SweepSettings& settings, const Observer& observer,
                   const Progress& progress, const std::function<bool()>& stop) {
  validate(motion, settings);
  const auto start = Clock::now();
  Leader leader{motion, settings, stop, motion.prepared ? motion.prepared : prepare(motion)};
  require(!leader.prepared->relaxes_in_time(), kNoHistory);
  leader.summary.run = new_summary(*leader.prepared);
  model::Snapshot found;
  double done = 0;
  try {
    if (settings.lead_in) find(leader, *settings.lead_in, found);
    for (double position : settings.positions) {
      if (find(leader, position, found)) {
        update(leader.summary.run, found);
        if (observer) observer(found);
      }
      leader.summary.run.time = position;
      report(progress, "sweep", ++done / static_cast<double>(settings.positions.size()));
    }
    leader.summary.run.complete = true;
  } catch (const Interrupted&) {
  }
  leader.summary.run.wall_time = seconds_since(start);
  return leader.summary;
}

}  // namespace elastogear::dynamics
