#include "app/sweep/sweep_run.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "app/console/console.h"
#include "app/console/outputs.h"
#include "app/gear/drive_system.h"
#include "app/gear/worm_options.h"
#include "app/setup/drive_input.h"
#include "app/setup/resumable_run.h"
#include "app/setup/system_setup.h"
#include "app/sweep/sweep_cases.h"
#include "app/sweep/sweep_options.h"
#include "app/sweep/sweep_results.h"
#include "app/sweep/work_queue.h"
#include "app/tables/contact_options.h"
#include "app/tables/marker_options.h"
#include "elastogear/base/collectively.h"
#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "elastogear/base/log_stage.h"
#include "elastogear/base/petsc.h"
#include "elastogear/base/text.h"

namespace elastogear::app {
namespace {

namespace fs = std::filesystem;

// A drive with values of its own, ready to be swept.
struct PreparedCase {
  Options options;
  dynamics::SlowMotion motion;
  model::ResultHeader header;
};

// A sweep as the options ask for it.
struct SweepJob {
  Options options;  // of the drive, with the names of its gears
  SweepCases cases;
  std::vector<double> positions;
  std::string output;  // a file, or a folder for several cases
  UnitStore store;
  KnownBodies known = {};

  std::vector<SweepUnit> units() const { return sweep_units(cases.cases.size(), positions.size()); }
  std::string file(std::size_t number) const;
};

std::string SweepJob::file(std::size_t number) const {
  if (!cases.several) return output;
  char name[32];
  std::snprintf(name, sizeof name, "case_%04zu.h5", number + 1);
  return (fs::path(output) / name).string();
}

int rank() {
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  return rank;
}

Drive drive_at_zero(Options options) {
  options.set("roll", "0");
  return read_drive(options);
}

PreparedCase prepare(SweepJob& job, std::size_t number) {
  const Options own = of_case(job.options, job.cases, job.cases.cases[number]);
  const Drive drive = drive_at_zero(own);
  PreparedCase prepared{with_system(own, drive), {}, {}};
  const SystemSetup setup = system_setup(prepared.options, &drive, job.known);
  prepared.motion = drive::slow_motion(drive, operation(prepared.options, drive),
                                       {setup.bodies, setup.pairs, setup.markers}, setup.environment);
  const dynamics::SlowMotion& motion = prepared.motion;
  prepared.motion.prepared = dynamics::prepare(motion);
  const dynamics::SystemModel& model = motion.prepared->model();
  prepared.header = result_header(prepared.options, &drive, model, job.known);
  if (number == 0) print_laws(prepared.options, model);
  return prepared;
}

// Values that no drive can have are found before anything is computed.
void check_cases(const Options& options, const SweepCases& cases) {
  const Silence silence;
  std::vector<std::string> of_first;
  for (const SweepCase& one : cases.cases) {
    const Variant& variant = cases.variants[static_cast<std::size_t>(one.variant)];
    try {
      const Options own = of_case(options, cases, one);
      const Drive drive = drive_at_zero(own);
      refuse_locked(own, drive);
      const std::vector<std::string> bearings = with_system(own, drive).list("bushings");
      if (&one == &cases.cases.front()) of_first = bearings;
      require(bearings == of_first, "has the bearings ", join(bearings), ", the first case ", join(of_first),
              ": all cases must have the same ones, of other stiffness perhaps; give them to the drive");
    } catch (const Error& error) {
      fail(variant.name.empty() ? "" : "variant '" + variant.name + "': ", error.what());
    }
  }
}

SweepJob make_job(const Options& given) {
  require(is_drive(given), given.label("analysis"),
          " = sweep: is for drives; name the kind by 'drive: cylindrical' or 'drive: worm'");
  const Options options = with_gears(given);
  SweepCases cases = sweep_cases(options);
  check_cases(options, cases);
  const Options first = of_case(options, cases, cases.cases.front());
  const Drive drive = drive_at_zero(first);
  print_facts(drive);
  const Options all = with_system(first, drive);
  all.reject_unknown(simulate_names(all));
  require_bodies(first, drive);
  require(!all.given("initial_file"), all.label("initial_file"), ": a sweep begins with the gears in touch");
  std::string output = all.text("output");
  if (cases.several) output = fs::path(output).replace_extension().string();
  return {options, std::move(cases), sweep_positions(all, drive), output, UnitStore(output)};
}

// Makes the folder of several cases. The lock is on the file that is written last.
std::string locked_file(const SweepJob& job) {
  if (!job.cases.several) return job.output;
  if (rank() == 0) {
    std::error_code error;
    fs::create_directories(job.output, error);
    require(!error, job.output, ": the folder of the cases cannot be made: ", error.message());
  }
  return (fs::path(job.output) / "cases.csv").string();
}

// Units of an earlier sweep of equal input stay. One that has found nothing keeps no other from its name.
void take_up(const SweepJob& job, const dynamics::ResumableSettings& settings,
             const dynamics::Provenance& input) {
  require_no_run(settings);
  const auto earlier =
      settings.resume == dynamics::Resume::discard ? std::nullopt : job.store.earlier_input();
  if (!earlier || !job.store.has_units()) return job.store.begin(input);
  const std::string other = differences(settings, input, *earlier);
  if (!other.empty() && settings.resume == dynamics::Resume::replace) {
    settings.on_replace(other);
    return job.store.begin(input);
  }
  require(other.empty() || settings.resume == dynamics::Resume::anyway, job.store.folder(),
          " holds a sweep that did not end, with other input: ", other,
          ". -resume anyway continues it with the present one, -resume discard begins anew");
  if (!other.empty()) print_item("warning", "continues a sweep with other input: " + other);
  const std::vector<SweepUnit> units = job.units();
  const auto has = [&](const SweepUnit& unit) { return job.store.has(unit); };
  const auto done = std::count_if(units.begin(), units.end(), has);
  // An Error before the work where another version of the program left them.
  if (done > 0) job.store.read(*std::find_if(units.begin(), units.end(), has));
  print_item("continued after", std::to_string(done) + " of " + std::to_string(units.size()) + " parts");
}

// Sweeps the units that this rank is given. Returns whether none was given up.
bool compute(SweepJob& job, const std::vector<SweepUnit>& units, WorkQueue& queue,
             const std::function<bool()>& stop) {
  const Progress progress = console_progress();
  const double all = static_cast<double>(job.units().size()), done = all - static_cast<double>(units.size());
  const auto tell = [&](double units_done) {
    if (units_done < static_cast<double>(units.size())) report(progress, "sweep", (done + units_done) / all);
  };
  tell(0);
  std::unique_ptr<PreparedCase> prepared;
  std::size_t number = 0;
  for (long u = queue.next(); u < static_cast<long>(units.size()); u = queue.next()) {
    const SweepUnit& unit = units[static_cast<std::size_t>(u)];
    if (!prepared || number != unit.number) {
      const Silence silence;  // the first case has been prepared, and said so, before
      number = unit.number;
      prepared = std::make_unique<PreparedCase>(prepare(job, number));
    }
    dynamics::SweepSettings settings = unit_settings(unit, job.positions);
    if (prepared->options.given("static_steps")) settings.steps = prepared->options.count("static_steps", 1);
    UnitResult result;
    result.summary = dynamics::sweep(
        prepared->motion, settings,
        [&](const model::Snapshot& snapshot) { result.snapshots.push_back(snapshot); },
        [&](std::string_view, double fraction) { tell(static_cast<double>(u) + fraction); }, stop);
    if (!result.summary.run.complete) return false;
    job.store.write(unit, result);
  }
  if (!units.empty()) report(progress, "sweep", 1);
  return true;
}

// Tells where the parts of a stopped sweep are that the same command goes on from. Empty where `resume`
// discards them.
std::string what_is_left(const SweepJob& job) {
  if (job.options.text("resume") == "discard") return "";
  return ". What was found is in " + job.store.folder() + "; the same command goes on from there";
}

// Sweeps what is left on all ranks. Error on all of them when one fails or is stopped.
void compute_all(SweepJob& job, const std::vector<SweepUnit>& todo,
                 const std::function<std::string()>& stop_cause) {
  WorkQueue queue(PETSC_COMM_WORLD, static_cast<long>(todo.size()));
  collectively(PETSC_COMM_WORLD, [&] {
    try {
      const bool all = compute(job, todo, queue, [&] { return !stop_cause().empty(); });
      require(all && stop_cause().empty(), "stopped by ", stop_cause(), what_is_left(job));
    } catch (const WriteFailure& failure) {
      queue.close();
      fail(failure.what(), what_is_left(job));
    } catch (...) {
      queue.close();
      throw;
    }
  });
}

// Makes the header of the first case that of another one, of these options.
void take_input(const Options& own, model::ResultHeader& header) {
  const Silence silence;
  const Drive drive = drive_at_zero(own);
  const Options all = with_system(own, drive);
  header.input = run_input(all, &drive);
  const std::vector<dynamics::PairSetup> pairs = pair_setups(all, all.list("bodies"));
  for (std::size_t p = 0; p < pairs.size(); ++p) header.pairs[p].friction = pairs[p].settings.friction.mu;
}

// Joins the units on rank 0.
SweepFound write_results(SweepJob& job, const PreparedCase& first) {
  SweepFound all;
  std::vector<std::string> files;
  std::vector<int> positions;
  for (std::size_t i = 0; i < job.cases.cases.size(); ++i) {
    std::vector<SweepUnit> units = sweep_units(1, job.positions.size());
    for (SweepUnit& unit : units) unit.number = i;
    model::ResultHeader header = first.header;
    if (i > 0) {
      const Options begun = of_case(job.options, job.cases, job.cases.cases[0]),
                    own = of_case(job.options, job.cases, job.cases.cases[i]);
      for (const auto& entry : begun.provenance()) header.provenance.erase(entry.first);
      for (const auto& [key, value] : own.provenance()) header.provenance[key] = value;
      take_input(own, header);
    }
    const SweepFound found = write_case(job.file(i), header, job.store, units);
    files.push_back(found.positions > 0 ? fs::path(job.file(i)).filename().string() : "");
    positions.push_back(found.positions);
    add(all, found);
  }
  if (job.cases.several)
    write_case_table((fs::path(job.output) / "cases.csv").string(), job.cases, files, positions);
  return all;
}

void print_sweep(const SweepJob& job, const SweepFound& found) {
  const dynamics::SweepSummary& summary = found.summary;
  const std::size_t wanted = job.cases.cases.size() * job.positions.size();
  if (job.cases.several) print_item("cases", std::to_string(job.cases.cases.size()));
  std::string counts = std::to_string(found.positions) + " of " + std::to_string(wanted);
  if (summary.restarts > 0)
    counts += ", " + std::to_string(summary.restarts) + " of them restarted from the unloaded state";
  print_item("roll angles", counts);
  print_detail("Newton iterations", std::to_string(summary.run.newton_iterations));
  for (const dynamics::PairSummary& pair : summary.run.pair)
    print_detail("contact " + pair.name, "peak force " + with_unit(pair.peak_force, "N") + " at roll angle " +
                                             with_unit(pair.peak_time, "pitches"));
  if (summary.run.unbalanced > 0)
    print_item("unbalanced", with_unit(100 * summary.run.unbalanced, "%") +
                                 " of the forces at most, where the active set of contact chatters");
  if (!job.cases.several) {
    print_detail("work of the torques", with_unit(found.work, "J"));
    print_detail("loss by friction", with_unit(found.dissipated, "J"));
    print_detail("largest error of the balance",
                 with_unit(found.largest_imbalance, "J") +
                     ": works are sums over the positions by the trapezoidal rule");
  }
  print_detail("time of all ranks", duration(summary.run.wall_time));
  print_detail("largest memory", largest_memory());
  print_item("written", job.output);
}

// The results are there, but not all of them.
void require_all_found(const SweepJob& job, const SweepFound& found) {
  const auto& missing = found.summary.missing;
  if (missing.empty()) return;
  fail("no equilibrium found at ", missing.size(), " of ", job.cases.cases.size() * job.positions.size(),
       " roll angles, which are missing in ", job.output, "; the first one is at roll ",
       missing.front().position, ": ", missing.front().why);
}

}  // namespace

void run_sweep(const Options& given) {
  SweepJob job = make_job(given);
  if (!job.cases.several) protect_inputs(given, {{"output", {job.output}}});  // else it is a folder
  const OutputLock lock(locked_file(job));
  const auto settings = resumable_settings(given, job.output);
  std::unique_ptr<PreparedCase> first;
  std::optional<LogStage> stage("bodies and set-up of contact");
  collectively(PETSC_COMM_WORLD, [&] {
    first = std::make_unique<PreparedCase>(prepare(job, 0));
    validate(first->motion, unit_settings({}, job.positions));
    if (rank() == 0) take_up(job, settings, first->header.provenance);
  });
  std::vector<SweepUnit> todo = job.units();
  std::erase_if(todo, [&](const SweepUnit& unit) { return job.store.has(unit); });
  stage.emplace("equilibria");
  compute_all(job, todo, settings.stop_cause);
  stage.emplace("results");
  SweepFound found;
  collectively(PETSC_COMM_WORLD, [&] {
    if (rank() != 0) return;
    found = write_results(job, *first);
    job.store.remove();
    print_sweep(job, found);
    require_all_found(job, found);
  });
}

}  // namespace elastogear::app
