#include "app/gear/drive_system.h"

#include "app/gear/bearing_options.h"
#include "app/gear/drive_options.h"
#include "elastogear/base/error.h"

namespace elastogear::app {
namespace {

// Exact flanks meet where their gap is least, between the nodes of the coarsest mesh, and do not enter each
// other there; bodies without residual flexibility do not either. What belongs to a penalty asks for one.
bool asks_for_penalty(const Options& options) {
  if (options.text("contact_law") != "auto") return options.text("contact_law") == "penalty";
  for (const char* name : {"contact_stiffness", "contact_damping", "contact_hysteresis"})
    if (options.given(name)) return true;
  return false;
}

}  // namespace

drive::Operation operation(const Options& options, const Drive& drive) {
  drive::Operation how{static_cast<drive::Analysis>(options.choice("analysis", model::analysis_names()))};
  const double sense = drive_start(options).coasts ? -1 : 1;
  how.torque = sense * options.number("torque");
  how.speed = sense * options.number("speed");
  const std::string own_torque = drive.members.front().name + "_torque";
  require(how.analysis != drive::Analysis::sweep || !options.given(own_torque), options.label(own_torque),
          ": a sweep has its torque on the first gear from option -torque, which its results name; give it "
          "there");
  require(drive.members.size() > 1, options.label("gears"), " = ", drive.members.front().name,
          ": a drive that runs has two gears at least");
  if (how.analysis != drive::Analysis::motion)
    require_torque_of_side(options, "torque", options.number("torque"));
  const bool loaded = how.torque != 0 || options.given("loads") || options.given("gravity") ||
                      !options.placeholder_values("<body>_torque").empty();
  require(how.analysis == drive::Analysis::motion || loaded,
          "option -torque is missing: on the first gear, as in 'torque: 300 N m'");
  for (const DriveMember& member : drive.members) how.bearings.push_back(bearings(options, member));
  return how;
}

drive::DriveSystem drive_system(const Options& options, const Drive& drive) {
  const drive::Operation how = operation(options, drive);
  drive::DriveSystem system = drive::drive_system(drive, how);
  if (how.analysis != drive::Analysis::motion) return system;
  for (dynamics::BodySetup& body : system.bodies) {
    if (!options.given(body.name + "_rotation_motion")) continue;
    body.rotation.load = {};
    body.rotation.s_dot_0 = 0;
    body.omega0.setZero();
    std::erase_if(system.markers.loads,
                  [&](const dynamics::LoadSetup& load) { return load.marker.body == body.name; });
  }
  return system;
}

Options with_system(Options options, const Drive& drive) {
  options.set_default("analysis", "static");
  const drive::DriveSystem system = drive_system(options, drive);
  std::string bodies, pairs;
  for (const DriveMember& member : drive.members) {
    bodies += (bodies.empty() ? "" : ",") + member.name;
    options.set_default(member.name + "_file", body_file(options, member));
  }
  for (const dynamics::PairSetup& pair : system.pairs) pairs += (pairs.empty() ? "" : ",") + pair.name;
  options.set_default("bodies", bodies);
  options.set_default("contact_pairs", pairs);
  options.set_default("contact_surface", "exact");
  if (!options.given("contact_two_pass") && !options.given("contact_points") && !asks_for_penalty(options)) {
    options.set("contact_points", "stations");
    if (options.text("contact_law") == "auto") options.set("contact_law", "unilateral");
  }
  options.set_default("output", drive_stem(options) + "_result.h5");
  for (const dynamics::BushingSetup& bushing : system.markers.bushings)
    options.append("bushings", bushing.name);
  for (const dynamics::LoadSetup& load : system.markers.loads) options.append("loads", load.name);
  return options;
}

}  // namespace elastogear::app
