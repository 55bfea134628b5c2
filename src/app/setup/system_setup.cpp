#include "app/setup/system_setup.h"

#include <algorithm>
#include <iterator>

#include "app/console/console.h"
#include "app/gear/bearing_options.h"
#include "app/gear/drive_options.h"
#include "app/gear/drive_system.h"
#include "app/options/rows.h"
#include "app/setup/resumable_run.h"
#include "app/tables/contact_options.h"
#include "app/tables/initial_state.h"
#include "app/tables/marker_options.h"
#include "elastogear/base/error.h"
#include "elastogear/dynamics/station_choice.h"

namespace elastogear::app {
namespace {

using dynamics::Environment;

const std::vector<std::string> kModuli = {"relaxing", "instantaneous", "long_term"};  // as in body::Moduli

bool has_states_of_rest(const Options& options) { return options.text("analysis") != "dynamic"; }

void read_moduli(const Options& options, const std::string& name, Environment& environment) {
  if (has_states_of_rest(options)) environment.moduli = body::Moduli::instantaneous;
  if (options.given(name)) environment.moduli = static_cast<body::Moduli>(options.choice(name, kModuli));
  if (options.text("analysis") == "static" && options.given("time_under_load")) {
    require(!options.given(name) || environment.moduli == body::Moduli::relaxing, options.label(name),
            ": materials relax during the time_under_load; leave it out");
    environment.moduli = body::Moduli::relaxing;
    return;
  }
  require(!has_states_of_rest(options) || environment.moduli != body::Moduli::relaxing, options.label(name),
          " = 'relaxing': static equilibria have no history; give instantaneous or long_term, or a "
          "time_under_load of analysis: static");
}

// Says whether the moduli of viscoelastic bodies relax, and otherwise which of them are taken.
void print_moduli(const dynamics::SystemModel& system) {
  std::string bodies;
  for (const dynamics::SystemModel::Body& body : system.bodies)
    if (!body.eq.body->relaxing.empty()) bodies += (bodies.empty() ? "" : ", ") + body.name;
  if (!bodies.empty())
    print_item("moduli", kModuli[static_cast<std::size_t>(system.environment.moduli)] + " (" + bodies + ")");
}

const Rows<Environment> kEnvironmentRows = {
    {"gravity", &Environment::gravity, "m/s^2", "acceleration of gravity in the world"},
    {"moduli", "-", "",
     "of viscoelastic materials: relaxing with time (analysis: dynamic, or static with time_under_load); "
     "instantaneous, as of loads put on just now; or long_term, after all relaxation (default: relaxing; of "
     "static equilibria, analysis: static, relax or sweep, instantaneous)",
     read_moduli},
    {"inertia", &Environment::inertia, body::inertia_level_names(),
     "what the inertia keeps of the deformation: constant (nothing), linear (first order), affine (all of "
     "its best affine field), or full (needs bodies reduced with -invariants full)"},
};

// Why flanks touch as the mesh has it, where nobody asks for that: what one pair lacks all of them lack.
// Flanks of rigid gears are never too stiff.
void print_what_lacks(const Options& options, const dynamics::SystemModel& system) {
  if (options.text("contact_points") != "stations" || std::ranges::all_of(system.bodies, dynamics::is_rigid))
    return;
  for (const dynamics::PairSetup& pair : system.pairs) {
    if (pair.settings.points == contact::SlavePoints::stations) continue;
    const std::string lacks = dynamics::lacks_for_stations(system, pair);
    if (!lacks.empty())
      print_item("contact at stations",
                 "not used for " + pair.name + ": " + lacks +
                     "; its contact compliance is that of the mesh, which is too small");
  }
}

std::string points_text(const contact::Settings& settings) {
  if (settings.points == contact::SlavePoints::faces) return "over faces";
  if (settings.points == contact::SlavePoints::minima) return "where gaps are least";
  if (settings.points == contact::SlavePoints::stations) return "at stations of exact flanks";
  return settings.two_pass ? "at nodes of both bodies" : "at nodes";
}

}  // namespace

OptionTable environment_table() { return table_of(kEnvironmentRows); }

SystemSetup system_setup(const Options& options, const Drive* drive, KnownBodies& known) {
  const std::vector<std::string> names = options.list("bodies");
  require(!names.empty(), "option -bodies is missing: names of the bodies");
  SystemSetup setup;
  const drive::DriveSystem start = drive ? drive_system(options, *drive) : drive::DriveSystem{};
  setup.pairs = pair_setups(options, names);
  read_rows(options, kEnvironmentRows, setup.environment);
  setup.markers = marker_setups(options, start.markers);
  for (const std::string& name : names) {
    BodyStart body{{.name = name}};
    for (std::size_t i = 0; i < start.bodies.size(); ++i)
      if (start.bodies[i].name == name)
        body = {start.bodies[i], &drive->members[i], bearings(options, drive->members[i])};
    setup.bodies.push_back(body_setup(options, body, known));
  }
  require_state_is_used(options, setup.bodies);
  return setup;
}

model::RunInput run_input(const Options& options, const Drive* drive) {
  model::RunInput input;
  if (drive) input = drive::run_input(*drive, operation(options, *drive), drive_start(options).roll);
  input.analysis = static_cast<model::Analysis>(options.choice("analysis", model::analysis_names()));
  input.creeps = input.analysis == model::Analysis::equilibrium && options.given("time_under_load") &&
                 options.number("time_under_load") > 0;
  for (const std::string& body : options.list("bodies"))
    if (options.given(body + "_deviation")) input.inexact.push_back(body);
  return input;
}

model::ResultHeader result_header(const Options& options, const Drive* drive,
                                  const dynamics::SystemModel& system, const KnownBodies& known) {
  model::ResultHeader header = dynamics::result_header(system);
  header.input = run_input(options, drive);
  for (auto& body : header.bodies) {
    const std::string file = body.name + "_file";
    body.file = options.given(file) ? options.text(file) : "";
  }
  header.provenance.merge(options.provenance());
  std::map<std::string, std::string> identities;
  for (const auto& [name, body] : known) identities[name] = body.identity;
  add_inputs(options, identities, header.provenance);
  return header;
}

void print_laws(const Options& options, const dynamics::SystemModel& system) {
  print_moduli(system);
  for (const dynamics::PairSetup& pair : system.pairs) {
    const bool unilateral = pair.settings.law != contact::ContactLaw::penalty;
    print_detail("law of contact", std::string(unilateral ? "unilateral" : "penalty") + ", " +
                                       points_text(pair.settings) + " (" + pair.name + ")");
    warn_of_facets(options, pair, options.list("bodies"));
  }
  print_what_lacks(options, system);
}

}  // namespace elastogear::app
