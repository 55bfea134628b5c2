#include "elastogear/dynamics/static.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "dynamics/equilibrium/equilibrium.h"
#include "dynamics/integrator/vec_view.h"
#include "dynamics/run/run.h"
#include "elastogear/base/error.h"

namespace elastogear::dynamics {
namespace {

// Takes each equilibrium that a static analysis finds: its energies, checks and summary.
struct Found {
  EnergyLedger ledger;
  Sanity sanity;
  RunSummary& summary;
  const Observer& observer;

  // time: in place of the load factor, by which the ledger knows the loads.
  void enter(Equilibrium& at, const LoadPath& path, double time, bool is_observed) {
    at.problem.system.accept(at.state(path.good));
    model::Snapshot found = snapshot(at.problem.system, at.state(path.good));
    sanity.require_small(found);
    ledger.enter(at.problem.system, found);
    found.time = time;
    if (!is_observed) return;
    update(summary, found);
    if (observer) observer(found);
  }
};

// Ends of the time steps in which materials relax for this time (s), equally far apart on a logarithmic axis.
std::vector<double> relaxing_times(const System& system, double whole) {
  constexpr double kPerDecade = 12, kFirst = 0.01;  // of the shortest relaxation time
  double shortest = whole;
  for (std::size_t b = 0; b < system.bodies().size(); ++b)
    for (double tau : system.relaxation_law(b).tau) shortest = std::min(shortest, tau);
  std::vector<double> times;
  for (int i = 0;; ++i) {
    times.push_back(kFirst * shortest * std::pow(10, i / kPerDecade));
    if (times.back() >= whole) break;
  }
  times.back() = whole;
  return times;
}

struct Span {
  double& reached;  // s
  double end;
};

// Relaxes to the end, or as far as there is an equilibrium: steps are halved where contact changes much.
void relax_once(Equilibrium& at, SNES snes, LoadPath& path, Span span, Found& to) {
  constexpr int kMostHalvings = 6;
  double step = span.end - span.reached;
  for (int halvings = 0;; ++halvings, step /= 2) {
    at.problem.system.advance_relaxation(step);
    if (find_equilibrium(at, snes, path.U, to.summary)) break;
    ++to.summary.rejected_steps;
    require(halvings < kMostHalvings, "no equilibrium found ", span.reached + step,
            " s after the load was put on: ", trouble_of(at));
    assign(path.U, path.good);
    if (!path.pairs.empty()) at.problem.system.set_forces(path.pairs);
  }
  span.reached = step == span.end - span.reached ? span.end : span.reached + step;
  ++to.summary.steps;
  path.good = *ReadView(path.U);
  path.pairs = at.problem.system.contacts(at.factor, path.good, at.zero).pair;
  to.enter(at, path, span.reached, true);
}

// Equilibria up to load factor 1, then with time; false: stopped before.
bool follow(Equilibrium& at, LoadPath& path, const StaticSettings& settings, Found& to,
            const Progress& progress) {
  System& system = at.problem.system;
  UniqueMat J;
  const UniqueSNES snes = make_snes(at, J);
  const bool relaxes = settings.time_under_load > 0;
  try {
    if (relaxes) system.advance_relaxation(0);
    report(progress, "static", path.reached);
    while (path.reached < 1) {
      if (!advance(at, snes, path, to.summary)) continue;
      to.enter(at, path, relaxes ? 0 : path.reached, !relaxes || path.reached == 1);
      report(progress, "static", path.reached);
    }
    if (!relaxes) return true;
    double reached = 0;
    report(progress, "relaxing", reached);
    for (double end : relaxing_times(system, settings.time_under_load))
      while (reached < end) {
        relax_once(at, snes, path, {reached, end}, to);
        report(progress, "relaxing", reached / settings.time_under_load);
      }
  } catch (const Interrupted&) {
    return false;
  }
  return true;
}

Signal scaled(const Signal& load, double time) {
  return load.value.empty() ? load : ramp_signal(at(load, time), 1);
}

}  // namespace

void scale_by_load_factor(BodySetup& setup, double time) {
  require(setup.velocity0.isZero(0) && setup.omega0.isZero(0), "body '", setup.name,
          "': a static analysis takes no initial velocity");
  for (Axis* axis : {&setup.rotation, &setup.translation}) {
    require(axis->s_dot_0 == 0, "body '", setup.name, "': a static analysis takes no initial velocity");
    axis->load = scaled(axis->load, time);
    if (!axis->drive) continue;
    const double from = at(*axis->drive, 0).s, to = at(*axis->drive, time).s;
    require(std::isfinite(to), "body '", setup.name,
            "': a prescribed motion needs the time up to which it goes");
    axis->drive = still_drive(from, to - from);
  }
}

void scale_by_load_factor(MarkerSetups& markers, double time) {
  for (LoadSetup& load : markers.loads) load.signal = scaled(load.signal, time);
}

void scale_by_load_factor(Environment& environment) { environment.gravity_rise = 1; }

RunSummary solve_static(System& system, const StaticSettings& settings, const Observer& observer,
                        const Progress& progress, const std::function<bool()>& stop) {
  require(settings.steps >= 1, "load steps ", settings.steps, " must be at least 1");
  const double under_load = settings.time_under_load;
  require(std::isfinite(under_load) && under_load >= 0, "time under load ", under_load,
          " s must be finite and not negative");
  require(under_load > 0 || !system.relaxes_in_time(), kNoHistory);
  require(under_load == 0 || system.relaxes_in_time(), "time under load ", under_load,
          " s: no material of the bodies relaxes with time");
  require_bodies_apart(system);
  const auto start = Clock::now();
  Equilibrium at(system);
  request_stop(at, stop);
  RunSummary summary = new_summary(system);
  LoadPath path(system, settings.steps);
  Found found{{}, Sanity(system), summary, observer};
  summary.complete = follow(at, path, settings, found, progress);
  summary.time = under_load > 0 ? under_load : std::max(0.0, path.reached);
  summary.wall_time = seconds_since(start);
  return summary;
}

}  // namespace elastogear::dynamics
