// elastogear simulate: bodies + joints + loads + contact -> result file.

#include <algorithm>
#include <cstdio>
#include <memory>

#include "app/console.h"
#include "app/verbs.h"
#include "elastogear/base/error.h"
#include "elastogear/base/petsc.h"
#include "elastogear/base/rotation.h"
#include "elastogear/dynamics/simulate.h"
#include "elastogear/io/body_file.h"
#include "elastogear/io/result_file.h"

namespace elastogear::app {
namespace {

const OptionTable kTable = {
    {"bodies", "-", "", "names of the bodies; each has its own <body>_... keys"},
    {"<body>_file", "-", "", "body file made by reduce"},
    {"<body>_position", "m", "0,0,0", "origin of the body frame in the world"},
    {"<body>_rotation", "rad", "0,0,0", "rotation vector from the body frame to the world"},
    {"<body>_joint", "-", "fixed", "fixed, or revolute about an axis through the origin of the body frame"},
    {"<body>_axis", "-", "0,0,1", "revolute: direction of the axis in the body frame"},
    {"<body>_angle0", "rad", "0", "revolute: initial angle"},
    {"<body>_omega0", "rad/s", "0", "revolute: initial angular velocity"},
    {"<body>_torque", "N m", "0", "revolute: constant torque about the axis"},
    {"contact_pairs", "-", "", "pairs of bodies that may touch, a:b"},
    {"contact_slave", "-", "first", "which body of a pair gives the slave nodes: first or second"},
    {"contact_two_pass", "-", "false",
     "check both bodies' nodes against the other's faces, half the stiffness each"},
    {"contact_penalty", "-", "per_area", "penalty stiffness per_area (Pa/m) or per_node (N/m)"},
    {"contact_stiffness", "Pa/m or N/m", "0",
     "penalty stiffness; 0: from material and size of the cells, both sides in series"},
    {"contact_depth", "m", "0", "deepest penetration still taken for contact; 0: from the size of the faces"},
    {"contact_kdop", "-", "24", "directions of the bounding volumes: 6, 14, 18, 24 or 26"},
    {"contact_skin", "m", "0",
     "relative motion after which the surfaces are searched anew; 0: from the size of the faces"},
    {"contact_update", "-", "bound",
     "how the trees follow the motion: bound (leaf-up, deformation bounded by the elastic energy), refit "
     "(leaf-up from the deformed surface) or realign (hull points)"},
    {"contact_tangent", "-", "full", "contact tangent: full, or normal (without its geometric part)"},
    {"inertia", "-", "linear", "dependence of the inertia on the deformation: constant or linear"},
    {"analysis", "-", "dynamic", "dynamic"},
    {"ts_dt", "s", "", "time step"},
    {"ts_max_time", "s", "", "end of the simulation"},
    {"ts_alpha_radius", "-", "1", "spectral radius rho_inf of generalised-alpha, 1: no numerical damping"},
    {"output", "-", "", "result file to write (HDF5)"},
    {"output_every", "-", "1", "write every n-th step"},
};

body::Joint joint(const Options& options, const std::string& prefix) {
  body::Joint joint;
  joint.type = options.choice(prefix + "joint", {"fixed", "revolute"}) == 0 ? body::JointType::fixed
                                                                            : body::JointType::revolute;
  joint.axis = options.vector(prefix + "axis");
  joint.r_WB0 = options.vector(prefix + "position");
  joint.R_WB0 = rotation_matrix(options.vector(prefix + "rotation"));
  return joint;
}

// A body reduced free has no nodes that carry its frame.
void check_free_body(const dynamics::BodySetup& setup) {
  if (!setup.body->floating) return;
  require(setup.body->basis == model::Basis::modal || setup.joint.type == body::JointType::fixed, "body ",
          setup.name,
          " was reduced free with the full basis, which contains rigid motions: its joint must be fixed");
  print_item("warning", "body " + setup.name +
                            " was reduced free, but a joint holds its frame: no node is held, " +
                            "its mean motion is");
}

dynamics::BodySetup body_setup(const Options& options, const std::string& name) {
  const std::string prefix = name + "_";
  dynamics::BodySetup setup;
  setup.name = name;
  setup.joint = joint(options, prefix);
  setup.rotation.s_0 = options.number(prefix + "angle0");
  setup.rotation.s_dot_0 = options.number(prefix + "omega0");
  setup.rotation.load = dynamics::constant_signal(options.number(prefix + "torque"));
  setup.body = std::make_shared<model::ElasticBody>(io::read_body(options.text(prefix + "file")));
  check_free_body(setup);
  return setup;
}

contact::Settings contact_settings(const Options& options) {
  contact::Settings settings;
  settings.k = options.count("contact_kdop");
  settings.slave = options.choice("contact_slave", {"first", "second"});
  settings.two_pass = options.flag("contact_two_pass");
  settings.penalty = options.choice("contact_penalty", {"per_area", "per_node"}) == 0
                         ? contact::Penalty::per_area
                         : contact::Penalty::per_node;
  settings.stiffness = options.number("contact_stiffness");
  settings.depth = options.number("contact_depth");
  settings.skin = options.number("contact_skin");
  settings.update =
      static_cast<contact::Update>(options.choice("contact_update", {"bound", "refit", "realign"}));
  settings.full_tangent = options.choice("contact_tangent", {"full", "normal"}) == 0;
  return settings;
}

int body_index(const std::vector<std::string>& bodies, const std::string& name, const std::string& pair) {
  const auto found = std::find(bodies.begin(), bodies.end(), name);
  require(found != bodies.end(), "option -contact_pairs = '", pair, "': there is no body '", name, "'");
  return static_cast<int>(found - bodies.begin());
}

std::vector<dynamics::PairSetup> pair_setups(const Options& options, const std::vector<std::string>& bodies) {
  std::vector<dynamics::PairSetup> setups;
  for (const std::string& pair : options.list("contact_pairs")) {
    const auto colon = pair.find(':');
    require(colon != std::string::npos, "option -contact_pairs = '", pair, "': must be two bodies, a:b");
    const int a = body_index(bodies, pair.substr(0, colon), pair);
    const int b = body_index(bodies, pair.substr(colon + 1), pair);
    setups.push_back({pair, {a, b}, contact_settings(options)});
  }
  return setups;
}

dynamics::TimeSettings time_settings(const Options& options) {
  dynamics::TimeSettings time;
  time.dt = options.positive("ts_dt");
  time.end_time = options.positive("ts_max_time");
  time.rho_inf = options.number("ts_alpha_radius");
  time.output_every = options.count("output_every", 1);
  return time;
}

void print_summary(const dynamics::RunSummary& run, const std::string& output) {
  print_item("time steps",
             std::to_string(run.steps) + " (" + std::to_string(run.rejected_steps) + " rejected)");
  print_item("Newton iterations", std::to_string(run.newton_iterations));
  for (const dynamics::PairSummary& pair : run.pair)
    print_item("contact " + pair.name, "peak force " + with_unit(pair.peak_force, "N") + " at " +
                                           with_unit(pair.peak_time, "s") + ", penetration " +
                                           with_unit(pair.penetration, "m"));
  print_item("contacts at one time", "at most " + std::to_string(run.most_contacts));
  print_item("energy at the start", with_unit(run.initial_energy, "J"));
  print_item("largest error of the balance", with_unit(run.largest_imbalance, "J"));
  print_item("time", duration(run.wall_time));
  print_item("written", output);
}

void run(const Options& options, const std::vector<std::string>&) {
  const std::vector<std::string> names = options.list("bodies");
  require(!names.empty(), "option -bodies is missing: names of the bodies");
  options.reject_unknown(names);
  options.choice("analysis", {"dynamic"});
  const std::string output = options.text("output");
  const dynamics::TimeSettings time = time_settings(options);
  const std::vector<dynamics::PairSetup> pairs = pair_setups(options, names);
  const auto level = options.choice("inertia", {"constant", "linear"}) == 0 ? body::InertiaLevel::constant
                                                                            : body::InertiaLevel::linear;
  std::vector<dynamics::BodySetup> bodies;
  for (const std::string& name : names) bodies.push_back(body_setup(options, name));

  dynamics::System system(std::move(bodies), pairs, {level});
  model::ResultHeader header = result_header(system);
  for (auto& body : header.bodies) body.file = options.text(body.name + "_file");
  header.provenance = options.provenance();
  io::ResultWriter writer(output, header);
  const dynamics::RunSummary summary = dynamics::simulate(
      system, time, [&](const model::Snapshot& snapshot) { writer.append(snapshot); }, console_progress());
  writer.finish();
  print_summary(summary, output);
}

}  // namespace

Verb simulate_verb() {
  return {"simulate", "simulate system.yaml [-option value ...]",
          "bodies, joints, loads, contact -> result file", kTable, run};
}

}  // namespace elastogear::app
