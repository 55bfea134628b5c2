#include "app/setup/loaded_start.h"

#include <optional>

#include "app/console/console.h"
#include "app/gear/drive_options.h"
#include "app/gear/drive_system.h"
#include "elastogear/base/error.h"
#include "elastogear/dynamics/static.h"

namespace elastogear::app {
namespace {

// Does a drive move under a torque alone, from a state that nobody has given?
bool begins_loaded(const Options& options) {
  return is_drive(options) && !options.given("initial_file") && options.number("torque") != 0 &&
         options.placeholder_values("<body>_rotation_motion").empty();
}

// For the static analysis of the drive. Viscoelastic materials that relax in the motion begin as under a load
// that was put on just now.
Options at_rest(const Options& given) {
  Options options = with_gears(given);
  options.set("analysis", "static");
  if (options.given("moduli") && options.text("moduli") == "relaxing") options.set("moduli", "instantaneous");
  return options;
}

}  // namespace

std::unique_ptr<dynamics::System> begin_loaded(const Options& given, KnownBodies& known,
                                               dynamics::SystemModel& model) {
  if (!begins_loaded(with_gears(given))) return nullptr;
  std::optional<Silence> silence(std::in_place);
  const Options options = at_rest(given);
  const Drive drive = read_drive(options);
  SystemSetup setup = system_setup(with_system(options, drive), &drive, known);
  make_static(setup, 0);
  auto still =
      std::make_unique<dynamics::System>(setup.bodies, setup.pairs, setup.environment, setup.markers);
  std::string found = "the equilibrium under its torque";
  try {
    std::vector<model::BodyState> states;
    solve_static(*still, {.steps = 1}, [&](const model::Snapshot& state) { states = state.bodies; });
    begin_with(model, states);
  } catch (const Error& error) {
    still.reset();
    found = std::string("undeformed gears, for there is no equilibrium under its torque: ") + error.what();
  }
  silence.reset();
  print_item("begins with", found);
  return still;
}

void make_static(SystemSetup& system, double time) {
  for (dynamics::BodySetup& setup : system.bodies) dynamics::scale_by_load_factor(setup, time);
  dynamics::scale_by_load_factor(system.markers, time);
  dynamics::scale_by_load_factor(system.environment);
}

}  // namespace elastogear::app
