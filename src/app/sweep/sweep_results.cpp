#include "app/sweep/sweep_results.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "elastogear/base/text.h"
#include "elastogear/io/result_file.h"

namespace elastogear::app {
namespace {

// Roll angles at which nothing was found, as an entry of the provenance.
std::string positions_text(const std::vector<dynamics::MissingPosition>& missing) {
  return join(missing, ",", [](const dynamics::MissingPosition& position) {
    char number[32];
    std::snprintf(number, sizeof number, "%.17g", position.position);
    return std::string(number);
  });
}

// The energies of a unit count from the last position of the one before.
void go_on_from(const model::Energies& before, model::Energies& energy) {
  energy.dissipated += before.dissipated;
  energy.work += before.work;
  energy.balance += before.balance;
}

void add_summary(dynamics::SweepSummary& all, const dynamics::SweepSummary& one) {
  all.restarts += one.restarts;
  all.missing.insert(all.missing.end(), one.missing.begin(), one.missing.end());
  dynamics::RunSummary& run = all.run;
  run.steps += one.run.steps;
  run.rejected_steps += one.run.rejected_steps;
  run.newton_iterations += one.run.newton_iterations;
  run.wall_time += one.run.wall_time;
  run.most_contacts = std::max(run.most_contacts, one.run.most_contacts);
  run.unbalanced = std::max(run.unbalanced, one.run.unbalanced);
  if (run.pair.empty()) run.pair = one.run.pair;
  for (std::size_t p = 0; p < one.run.pair.size(); ++p) {
    const double penetration = std::max(run.pair[p].penetration, one.run.pair[p].penetration);
    if (one.run.pair[p].peak_force > run.pair[p].peak_force) run.pair[p] = one.run.pair[p];
    run.pair[p].penetration = penetration;
  }
}

}  // namespace

SweepFound write_case(const std::string& path, const model::ResultHeader& header, const UnitStore& store,
                      const std::vector<SweepUnit>& units) {
  SweepFound found;
  for (const SweepUnit& unit : units) {
    const UnitResult result = store.read(unit);
    add_summary(found.summary, result.summary);
    for (std::size_t p = 0; p < found.summary.run.pair.size(); ++p)
      found.summary.run.pair[p].name = header.pairs[p].name;
    found.positions += static_cast<int>(result.snapshots.size());
  }
  if (found.positions == 0) return found;
  model::ResultHeader own = header;
  if (!found.summary.missing.empty())
    own.provenance["missing_positions"] = positions_text(found.summary.missing);
  io::ResultWriter writer(path, own);
  model::Energies last;
  for (const SweepUnit& unit : units) {
    UnitResult result = store.read(unit);
    const model::Energies before = last;
    for (model::Snapshot& snapshot : result.snapshots) {
      go_on_from(before, snapshot.energy);
      writer.append(snapshot);
      last = snapshot.energy;
      found.largest_imbalance = std::max(found.largest_imbalance, std::abs(last.balance));
    }
  }
  writer.finish();
  found.work = last.work;
  found.dissipated = last.dissipated;
  return found;
}

void add(SweepFound& all, const SweepFound& one) {
  const int positions = all.positions + one.positions;
  dynamics::SweepSummary summary = all.summary;
  add_summary(summary, one.summary);
  all = one;
  all.positions = positions;
  all.summary = summary;
}

}  // namespace elastogear::app
