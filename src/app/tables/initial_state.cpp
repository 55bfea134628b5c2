#include "app/tables/initial_state.h"

#include <algorithm>

#include "app/options/file_time.h"
#include "app/options/rows.h"
#include "elastogear/base/error.h"
#include "elastogear/io/relaxed_state.h"
#include "elastogear/io/result_file.h"
#include "elastogear/recovery/deviation.h"

namespace elastogear::app {
namespace {

// The result file whose state bodies begin with, and the time in it.
struct InitialState {
  std::string file;         // empty: there is none
  double time = kLastTime;  // s
};

const Rows<InitialState> kStateRows = {
    {"initial_file", &InitialState::file, "-",
     "result file whose joint coordinates and (dynamic analysis) rates the bodies of the same names begin "
     "with; elastic coordinates begin with zero, but after a time_under_load with those of its end, and "
     "viscoelastic bodies with what they remember"},
    {"initial_time", "s", "last", "time in that file: a number or last",
     [](auto& o, auto& name, auto& state) { state.time = file_time(o, name); }},
};

InitialState initial_state(const Options& options) {
  InitialState state;
  if (options.given("initial_file")) read_rows(options, kStateRows, state);
  return state;
}

// The axes of a joint in the order of its coordinates.
std::vector<dynamics::Axis*> axes(dynamics::BodySetup& setup) {
  std::vector<dynamics::Axis*> all;
  if (body::has_rotation_axis(setup.joint.type)) all.push_back(&setup.rotation);
  if (body::has_translation_axis(setup.joint.type)) all.push_back(&setup.translation);
  return all;
}

}  // namespace

OptionTable initial_state_table() { return table_of(kStateRows); }

void require_state_is_used(const Options& options, const std::vector<dynamics::BodySetup>& bodies) {
  const std::string file = initial_state(options).file;
  if (file.empty()) {
    require(!options.given("initial_time"),
            "option -initial_time needs -initial_file, the file of that time");
    return;
  }
  const auto known = io::read_result_header(file).bodies;
  const bool used = std::any_of(bodies.begin(), bodies.end(), [&](const auto& setup) {
    if (!setup.relaxed0.empty()) return true;
    return setup.joint.type != body::JointType::fixed &&
           std::any_of(known.begin(), known.end(), [&](const auto& b) { return b.name == setup.name; });
  });
  require(used, "option -initial_file = '", file,
          "': none of the bodies that can move is in it, so that nothing would begin with its state");
}

void set_relaxed_state(const Options& options, dynamics::BodySetup& setup) {
  const auto [file, wanted] = initial_state(options);
  if (file.empty() || options.text("analysis") != "dynamic") return;
  setup.relaxed0 = io::read_relaxed_state(file, setup.name);
  require(setup.relaxed0.empty() || wanted == kLastTime, "option -initial_time: body '", setup.name,
          "' begins with its deformation, which ", file, " has of the last time only");
}

void set_initial_state(const Options& options, dynamics::BodySetup& setup) {
  const auto [file, wanted] = initial_state(options);
  if (file.empty() || setup.joint.type == body::JointType::fixed) return;
  const auto bodies = io::read_result_header(file).bodies;
  if (std::none_of(bodies.begin(), bodies.end(), [&](const auto& b) { return b.name == setup.name; })) return;
  require(!body::has_rotation_vector(setup.joint.type), "option -initial_file: body '", setup.name,
          "' is on a joint without an axis, which cannot begin with the state of a file");
  const io::BodyHistory history = io::read_joint_history(file, setup.name);
  const std::vector<dynamics::Axis*> all = axes(setup);
  require(history.s.rows() == static_cast<Eigen::Index>(all.size()), file, ": body '", setup.name, "' has ",
          history.s.rows(), " joint coordinates, here it has ", all.size());
  const Eigen::VectorXd time = io::read_times(file);
  const Eigen::VectorXd at =
      Eigen::VectorXd::Constant(1, wanted == kLastTime ? time[time.size() - 1] : wanted);
  const bool moves = options.text("analysis") == "dynamic";
  const Eigen::VectorXd s = recovery::at_times(time, history.s, at),
                        s_dot = recovery::at_times(time, history.s_dot, at);
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i]->s_0 = s[static_cast<Eigen::Index>(i)];
    all[i]->s_dot_0 = moves ? s_dot[static_cast<Eigen::Index>(i)] : 0;
  }
}

}  // namespace elastogear::app
