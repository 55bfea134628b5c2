#include "elastogear/dynamics/static.h"

#include <cmath>

#include "dynamics/equilibrium/equilibrium.h"
#include "dynamics/run.h"
#include "dynamics/vec_view.h"
#include "elastogear/base/error.h"

namespace elastogear::dynamics {
namespace {

// Equilibria up to load factor 1; false: stopped before.
bool follow(Equilibrium& at, LoadPath& path, RunSummary& summary, const Observer& observer,
            const Progress& progress) {
  EnergyLedger ledger;
  const Sanity sanity(at.problem.system);
  UniqueMat J;
  const UniqueSNES snes = make_snes(at, J);
  while (path.reached < 1) {
    try {
      if (!advance(at, snes, path, summary)) continue;
    } catch (const Interrupted&) {
      return false;
    }
    at.problem.system.accept(at.state(path.good));
    model::Snapshot found = snapshot(at.problem.system, at.state(path.good));
    sanity.require_small(found);
    ledger.enter(at.problem.system, found);
    update(summary, found);
    if (observer) observer(found);
    report(progress, "static", path.reached);
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
  require(!system.relaxes_in_time(), kNoHistory);
  require_bodies_apart(system);
  const auto start = Clock::now();
  Equilibrium at(system);
  let_stop(at, stop);
  RunSummary summary = new_summary(system);
  LoadPath path(system, settings.steps);
  summary.complete = follow(at, path, summary, observer, progress);
  summary.time = std::max(0.0, path.reached);
  summary.wall_time = seconds_since(start);
  return summary;
}

}  // namespace elastogear::dynamics
