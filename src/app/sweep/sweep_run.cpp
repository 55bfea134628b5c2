#include "app/sweep/sweep_run.h"

#include "app/console/console.h"
#include "app/console/outputs.h"
#include "app/gear/drive_options.h"
#include "app/resumable_run.h"
#include "app/sweep/sweep_options.h"
#include "app/tables/marker_options.h"
#include "elastogear/base/error.h"

namespace elastogear::app {

void run_sweep(const Options& given) {
  require(is_drive(given), given.label("analysis"),
          " = sweep: is for drives; name one by 'drive: cylindrical' ", "or 'drive: worm'");
  const Options with_names = with_gears(given);
  Options at_zero = with_names;
  at_zero.set("roll", "0");
  const Drive drive = read_drive(at_zero);
  print_drive(drive);
  const Options options = with_system(with_names, drive);
  options.reject_unknown(simulate_names(options));
  const std::string output = options.text("output");
  protect_inputs(options, {{"output", {output}}});
  const OutputLock lock(output);
  KnownBodies known;
  const SystemSetup setup = system_setup(options, known);
  const dynamics::SlowMotion motion = slow_motion(options, drive, setup);
  const auto model =
      dynamics::make_system_model(motion.bodies, motion.pairs, motion.environment, motion.markers);
  print_laws(options, model);
  dynamics::SweepSettings settings{.positions = sweep_positions(options, drive)};
  dynamics::SweepSummary summary;
  keep(options, result_header(options, model, known),
       [&](const dynamics::Observer& observer, const dynamics::Checkpoints& checkpoints) {
         summary = dynamics::sweep(motion, settings, observer, console_progress(), checkpoints.stop);
         return summary.run;
       });
  for (const dynamics::MissingPosition& missing : summary.missing)
    print_item("warning", "no equilibrium at roll " + with_unit(missing.position, "") + missing.why);
  print_item("Newton iterations", std::to_string(summary.run.newton_iterations));
  print_item("time", duration(summary.run.wall_time));
  print_item("written", output);
}

}  // namespace elastogear::app
