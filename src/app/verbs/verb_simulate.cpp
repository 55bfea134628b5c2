// elastogear simulate: bodies + joints + loads + contact -> result file.

#include <algorithm>
#include <limits>
#include <map>
#include <memory>
#include <optional>

#include "app/console/advice.h"
#include "app/console/blas_kernels.h"
#include "app/console/console.h"
#include "app/console/outputs.h"
#include "app/console/plausibility.h"
#include "app/gear/drive_options.h"
#include "app/gear/drive_system.h"
#include "app/options/rows.h"
#include "app/options/verbs.h"
#include "app/setup/drive_input.h"
#include "app/setup/loaded_start.h"
#include "app/setup/resumable_run.h"
#include "app/setup/system_setup.h"
#include "app/sweep/sweep_cases.h"
#include "app/sweep/sweep_options.h"
#include "app/sweep/sweep_run.h"
#include "app/tables/body_options.h"
#include "app/tables/contact_options.h"
#include "app/tables/initial_state.h"
#include "app/tables/marker_options.h"
#include "app/tables/output_options.h"
#include "app/verbs/simulation.h"
#include "elastogear/base/error.h"
#include "elastogear/base/log_stage.h"
#include "elastogear/base/petsc.h"
#include "elastogear/dynamics/static.h"
#include "elastogear/io/relaxed_state.h"
#include "elastogear/io/result_file.h"

namespace elastogear::app {
namespace {

struct AnalysisSettings {
  model::Analysis kind = model::Analysis::motion;
  int static_steps = 10;
  double time_under_load = 0;  // s
};

using dynamics::Environment, dynamics::TimeSettings, model::Analysis;

const Rows<AnalysisSettings> kAnalysisRows = {
    {"analysis", &AnalysisSettings::kind, model::analysis_names(),
     "dynamic; static: equilibrium, the loads grow in static_steps steps (time in the result: load factor, "
     "or s under load); "
     "relax: motion with velocities set to zero at each peak of the kinetic energy, until all rests; or "
     "sweep: equilibria of a drive at many roll angles (time in the result: pitches), with sweep_..., "
     "torques "
     "and variants"},
    {"static_steps", &AnalysisSettings::static_steps, "-",
     "load steps of a static analysis; sweep: at its first position (default: 10; sweep: 1)",
     kPositive | kDependent},
    {"time_under_load", &AnalysisSettings::time_under_load, "s",
     "static: viscoelastic materials relax for this time under the whole load (time in the result: since it "
     "was put on); a dynamic run begins with the last state by initial_file; 0: they do not"},
};

const Rows<TimeSettings> kTimeRows = {
    {"rest_tolerance", &TimeSettings::rest_tolerance, "-",
     "relax: largest unbalanced share of the forces at rest (default: 1e-6; 1e-4 where friction sticks)",
     kPositive | kDependent},
    {"ts_dt", &TimeSettings::dt, "s",
     "time step, with step_tolerance the first one (default: steps are chosen by step_error; relax: none)",
     kPositive | kDependent},
    {"ts_max_time", &TimeSettings::end_time, "s",
     "end of the simulation; static: time of loads and prescribed motions, without it loads take their last "
     "value",
     kPositive | kRequired},
    {"ts_alpha_radius", &TimeSettings::rho_inf, "-",
     "spectral radius rho_inf of generalised-alpha, 1: no numerical damping (default: with ts_dt 1, without "
     "0.8; relax: 0)",
     kDependent},
    {"output", "-", "", "result file to write (HDF5)"},
    {"step_error", &TimeSettings::step_error, "-",
     "without ts_dt and step_tolerance: choose the steps so that the local error is at most this share of "
     "elastic displacements and, in the energy norm, of the elastic state of each body, as stresses are",
     kPositive},
    {"step_tolerance", &TimeSettings::step_tolerance, "m",
     "choose the steps so that the local error moves no surface node farther; 0: steps of ts_dt, or by "
     "step_error"},
    {"velocity_tolerance", &TimeSettings::velocity_tolerance, "m/s",
     "with step_tolerance: the same for velocities; 0: without"},
};

OptionTable simulate_table() {
  OptionTable all = body_table();
  for (const OptionTable& part :
       {environment_table(), table_of(kAnalysisRows, kTimeRows), sweep_table(), case_table(), output_table(),
        contact_table(), initial_state_table(), resumable_run_table(), marker_table(), whole_drive_table()})
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

AnalysisSettings analysis_settings(const Options& options) {
  AnalysisSettings settings;
  read_rows(options, kAnalysisRows, settings);
  return settings;
}

Analysis analysis(const Options& options) { return analysis_settings(options).kind; }

// rho_inf where steps are chosen: vibrations that the tolerance lets pass unresolved die out, and with them
// the iterations that they cost (docs/performance.md).
constexpr double kDamped = 0.8;

// With friction that sticks, rest is a range of states, in which nodes creep on for tens of thousands of
// steps (docs/theory, section 8.7): the default of rest_tolerance is larger then.
TimeSettings time_settings(const Options& options) {
  TimeSettings time;
  time.relax = analysis(options) == Analysis::relaxation;
  if (time.relax)
    time.rho_inf = 0;
  else if (!options.given("ts_dt"))
    time.rho_inf = kDamped;
  if (friction_sticks(options)) time.rest_tolerance = 1e-4;
  read_rows(options, kTimeRows, time);
  set_output_times(options, time);
  require(time.end_time >= time.dt, options.label("ts_max_time"), " = ", time.end_time,
          " s: ends before the first step, -ts_dt = ", time.dt, " s");
  return time;
}

// With 18 nodes on the patch its largest pressure is 4 % off (docs/validation/contact.md, section Flank),
// with 37 less than 0.1 %. Stations do not need a mesh that resolves it.
void print_resolution(const Options& options, const dynamics::SystemModel& system,
                      const dynamics::RunSummary& run) {
  constexpr int kResolved = 18;
  const int passes = options.flag("contact_two_pass") ? 2 : 1;
  for (std::size_t p = 0; const dynamics::PairSummary& pair : run.pair)
    if (system.pairs[p++].settings.points != contact::SlavePoints::stations && pair.peak_force > 0 &&
        pair.patch_nodes < kResolved * passes)
      print_item("warning",
                 "contact " + pair.name + ": too coarse a surface; its busiest area of contact has " +
                     std::to_string((pair.patch_nodes + passes - 1) / passes) + " of the " +
                     std::to_string(kResolved) + " nodes that resolve a patch to 4 %: pressures and " +
                     "stresses under the contact are not to be trusted; take a finer mesh there");
}

// Numerical damping takes energy away, an unstable integration makes it: neither may matter.
void warn_of_balance(const dynamics::RunSummary& run) {
  constexpr double kNoticed = 0.01;
  if (run.largest_imbalance <= kNoticed * run.turned_over) return;
  char share[32];
  std::snprintf(share, sizeof share, "%.2g %%", 100 * run.largest_imbalance / run.turned_over);
  print_item("warning", "the energy balance is off by " + std::string(share) + " of the " +
                            with_unit(run.turned_over, "J") +
                            " that were turned over: by numerical damping of vibrations that steps do not "
                            "resolve, by impacts, or by instability; try a smaller step_error or ts_dt");
}

void print_summary(const Options& options, const dynamics::SystemModel& system, const io::TimeAxis& axis,
                   const dynamics::RunSummary& run) {
  print_item("time steps",
             std::to_string(run.steps) + " (" + std::to_string(run.rejected_steps) + " rejected)");
  if (run.step_tolerance > 0)
    print_item("steps are chosen", with_unit(run.time / std::max(run.steps, 1), "s") +
                                       " in the mean, local error at most " +
                                       with_unit(run.step_tolerance, "m"));
  print_item("Newton iterations", std::to_string(run.newton_iterations));
  for (const dynamics::PairSummary& pair : run.pair)
    print_item("contact " + pair.name, "peak force " + with_unit(pair.peak_force, "N") + " at " +
                                           axis.at(pair.peak_time) + ", penetration " +
                                           with_unit(pair.penetration, "m"));
  warn_of_idle_pairs(run);
  print_item("contacts at one time", "at most " + std::to_string(run.most_contacts));
  print_resolution(options, system, run);
  if (analysis(options) == Analysis::relaxation)
    print_item(run.at_rest ? "at rest after" : "warning",
               run.at_rest ? with_unit(run.time, "s") : "not yet at rest");
  if (analysis(options) == Analysis::motion)
    print_item("energy at the start", with_unit(run.initial_energy, "J"));
  if (analysis(options) == Analysis::equilibrium) print_item("work of the loads", with_unit(run.work, "J"));
  if (run.unbalanced > 0)
    print_item("unbalanced", with_unit(100 * run.unbalanced, "%") +
                                 " of the forces at most, where the active set of contact chatters");
  if (analysis(options) != Analysis::relaxation)
    print_item("largest error of the balance", with_unit(run.largest_imbalance, "J"));
  if (analysis(options) == Analysis::motion) warn_of_balance(run);
  print_item("time", duration(run.wall_time));
  print_item("largest memory", largest_memory());
  print_item("written", options.text("output"));
}

// The time of the loads that a static analysis takes, s.
double time_of_loads(const Options& options) {
  return options.given("ts_max_time") ? options.positive("ts_max_time")
                                      : std::numeric_limits<double>::infinity();
}

std::string step_text(const dynamics::StepInfo& step) {
  const auto brief = [](double value, const char* unit) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g %s", value, unit);
    return std::string(text);
  };
  const std::string relaxing = step.unbalanced >= 0 ? ", unbalanced " + brief(step.unbalanced, "") : "";
  return relaxing + ", t " + brief(step.time, "s") + ", balance " + brief(step.balance, "J") + ", " +
         std::to_string(step.contacts) + " contacts " + brief(step.penetration, "m") + " deep, dt " +
         brief(step.dt, "s") + ", " + std::to_string(step.newton_iterations) + " iterations in " +
         std::to_string(step.step) + " steps";
}

dynamics::Computation computation(const Options& options, dynamics::System& system) {
  if (analysis(options) == Analysis::equilibrium)
    return [&system, given = analysis_settings(options)](const dynamics::Observer& observer,
                                                         const dynamics::Checkpoints& checkpoints) {
      return dynamics::solve_static(system, {given.static_steps, given.time_under_load},
                                    guarded(system, observer), console_progress(), checkpoints.stop);
    };
  TimeSettings time = time_settings(options);
  if (analysis(options) == Analysis::motion) print_advice(system, time.dt);
  auto info = std::make_shared<dynamics::StepInfo>();
  time.monitor = paced(time, [info](const dynamics::StepInfo& step) { *info = step; });
  return [&system, time, info](const auto& observer, const auto& checkpoints) {
    return dynamics::simulate(system, time, guarded(system, observer, time.dt),
                              console_progress([info] { return step_text(*info); }), checkpoints);
  };
}

// The deformation of all bodies at the end of a run, with what viscoelastic ones remember, for a next one,
// and that at its start.
void add_relaxed_states(const std::string& output, const dynamics::System& system, bool at_end) {
  std::map<std::string, model::RelaxedState> end, start;
  for (std::size_t b = 0; b < system.bodies().size(); ++b) {
    const dynamics::System::Body& body = system.bodies()[b];
    if (at_end && body.eq.n_q() > 0) end[body.name] = system.relaxed_state(b);
    if (!body.relaxed.empty()) start[body.name] = body.relaxed;
  }
  if (!end.empty()) io::add_relaxed_states(output, end);
  if (!start.empty()) io::add_relaxed_states(output, start, io::kRelaxedStart);
}

// Options of a run, and the drive that they describe, which says what bodies there are and where.
struct Input {
  Options options;
  std::optional<Drive> drive = {};

  const Drive* drive_or_null() const { return drive ? &*drive : nullptr; }
};

Input input_of(const Options& given) {
  const Options options = with_gears(given);
  if (!is_drive(options)) return {options};
  const Drive drive = read_drive(options);
  print_facts(drive);
  Input input{with_system(options, drive), drive};
  return input;
}

void require_known(const Input& input) {
  input.options.reject_unknown(simulate_names(input.options));
  if (input.drive) require_bodies(input.options, *input.drive);
}

// Static responses alone have no inertia.
void require_modes_of(const std::vector<dynamics::BodySetup>& bodies) {
  for (const dynamics::BodySetup& body : bodies)
    require(!body.body || body.body->n_q() > 0 || body.body->flexibility.empty(), "body '", body.name,
            "' has no modes, only static responses, which serve analyses at rest: reduce it with modes");
}

// given: before options of the system were derived from those of a drive.
std::unique_ptr<dynamics::System> make_system(const Options& given, Analysis kind, const SystemSetup& setup,
                                              KnownBodies& known) {
  dynamics::SystemModel model =
      dynamics::make_system_model(setup.bodies, setup.pairs, setup.environment, setup.markers);
  if (kind != Analysis::equilibrium) require_modes_of(setup.bodies);
  const auto still = kind == Analysis::motion ? begin_loaded(given, known, model) : nullptr;
  return still ? std::make_unique<dynamics::System>(std::move(model), *still)
               : std::make_unique<dynamics::System>(std::move(model));
}

void run_simulate(const Options& given, const std::vector<std::string>&) {
  const OneBlasThread one_thread;
  if (analysis(given) == Analysis::sweep) return run_sweep(given);
  int n_ranks = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &n_ranks);
  require(n_ranks == 1, "runs on one rank, not on ", n_ranks,
          ", but for analysis: sweep: call it without mpirun");
  const Input input = input_of(given);
  const Options& options = input.options;
  require(!options.list("bodies").empty(), "option -bodies is missing: names of the bodies");
  require_known(input);
  const std::string output = options.text("output");
  protect_inputs(options, {{"output", {output}}, {"sensor_csv", sensor_tables(options)}});
  const OutputLock lock(output);
  if (analysis(options) != Analysis::equilibrium) time_settings(options);
  require(analysis(options) == Analysis::equilibrium || !options.given("time_under_load"),
          options.label("time_under_load"), ": belongs to analysis: static");
  std::optional<LogStage> stage("bodies and set-up of contact");
  KnownBodies known;
  SystemSetup setup = system_setup(options, input.drive_or_null(), known);
  if (analysis(options) == Analysis::equilibrium) make_static(setup, time_of_loads(options));

  const auto made = make_system(given, analysis(options), setup, known);
  dynamics::System& system = *made;
  const model::ResultHeader head = result_header(options, input.drive_or_null(), system.model(), known);
  print_laws(options, system.model());
  stage.emplace(analysis(options) == Analysis::equilibrium ? "equilibria" : "motion");
  print_summary(options, system.model(), io::time_axis(head.input),
                keep(options, head, computation(options, system)));
  add_relaxed_states(output, system, analysis_settings(options).time_under_load > 0);
  write_sensor_tables(options, head);
}

dynamics::Axis& axis_of(dynamics::BodySetup& body, const std::string& name) {
  const body::JointType joint = body.joint.type;
  const bool turns = body::has_rotation_axis(joint), slides = body::has_translation_axis(joint);
  require(turns || slides, "force on '", name, "': the joint of this body has no axis, it is ",
          body::joint_names()[static_cast<std::size_t>(joint)],
          "; name a load (option loads) at a marker of the body");
  require(turns != slides, "force on '", name, "': this body turns and slides; name ", name, ".rotation or ",
          name, ".translation");
  return turns ? body.rotation : body.translation;
}

// The axis that "worm", "worm.rotation" or "worm.translation" names.
dynamics::Axis& find_axis(std::vector<dynamics::BodySetup>& bodies, const std::string& name) {
  std::string known;
  for (dynamics::BodySetup& body : bodies) {
    if (name == body.name) return axis_of(body, name);
    if (name == body.name + ".rotation" && body::has_rotation_axis(body.joint.type)) return body.rotation;
    if (name == body.name + ".translation" && body::has_translation_axis(body.joint.type))
      return body.translation;
    known += (known.empty() ? "" : ", ") + body.name;
  }
  fail("force on '", name, "': there is no such axis; the bodies are ", known);
}

void set_laws(const ProgramLaws& laws, SystemSetup& setup) {
  for (const auto& [name, law] : laws.of_axes) find_axis(setup.bodies, name).law = law;
  for (const auto& [name, law] : laws.of_loads) {
    const auto load = std::find_if(setup.markers.loads.begin(), setup.markers.loads.end(),
                                   [&name = name](const auto& l) { return l.name == name; });
    require(load != setup.markers.loads.end(), "force on '", name,
            "': there is no such load; option loads names them, with load_marker");
    load->law = law;
  }
}

}  // namespace

PreparedSimulation prepare_simulation(const Options& given, const MakeLaws& make_laws) {
  Options motion = given;
  if (is_drive(motion)) motion.set_default("analysis", "dynamic");
  const Input input = input_of(motion);
  const Options& options = input.options;
  require_known(input);
  const Analysis kind = analysis(options);
  require(kind == Analysis::motion || kind == Analysis::relaxation, options.label("analysis"), " = '",
          options.text("analysis"), "': has no time steps; give analysis: dynamic or relax");
  TimeSettings time = time_settings(options);
  KnownBodies known;
  SystemSetup setup = system_setup(options, input.drive_or_null(), known);
  set_laws(make_laws(options.list("loads")), setup);
  PreparedSimulation prepared{make_system(motion, kind, setup, known), time, {}};
  prepared.header = result_header(options, input.drive_or_null(), prepared.system->model(), known);
  print_laws(options, prepared.system->model());
  return prepared;
}

Verb simulate_verb() {
  return {"simulate",
          "simulate system.yaml [-option value ...]",
          "bodies, joints, loads, contact -> result file",
          simulate_table(),
          run_simulate,
          "-snes_*, in time -ts_*, with bodies of basis full -elastic_* and -ksp_*; ",
          true};
}

}  // namespace elastogear::app
