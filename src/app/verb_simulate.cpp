// elastogear simulate: bodies + joints + loads + contact -> result file.

#include <algorithm>
#include <cstdio>
#include <memory>
#include <utility>

#include "app/console.h"
#include "app/marker_options.h"
#include "app/motion.h"
#include "app/verbs.h"
#include "elastogear/base/error.h"
#include "elastogear/base/petsc.h"
#include "elastogear/base/rotation.h"
#include "elastogear/body/rigid.h"
#include "elastogear/dynamics/simulate.h"
#include "elastogear/io/body_file.h"
#include "elastogear/io/result_file.h"

namespace elastogear::app {
namespace {

const OptionTable kOptions = {
    {"bodies", "-", "", "names of the bodies; each has its own <body>_... keys"},
    {"<body>_file", "-", "", "body file made by reduce; without one give mass and inertia"},
    {"<body>_rigid", "-", "false", "leave out the elastic coordinates of the file"},
    {"<body>_mass", "kg", "", "rigid body without a file: mass"},
    {"<body>_center", "m", "0,0,0", "rigid body without a file: centre of mass in the body frame"},
    {"<body>_inertia", "kg m^2", "", "rigid body without a file: xx,yy,zz,xy,yz,xz about the centre of mass"},
    {"<body>_position", "m", "0,0,0", "origin of the body frame in the world"},
    {"<body>_rotation", "rad", "0,0,0", "rotation vector from the body frame to the world"},
    {"<body>_joint", "-", "fixed", "fixed, revolute, prismatic, cylindrical, spherical or free"},
    {"<body>_axis", "-", "0,0,1", "direction of the joint's axis in the body frame"},
    {"<body>_point", "m", "0,0,0", "point of the axis, or centre of a spherical joint, in the body frame"},
    {"<body>_angle0", "rad", "0", "initial angle about the axis"},
    {"<body>_omega0", "rad/s", "0",
     "initial angular velocity: about the axis; free, spherical: x,y,z in the body frame"},
    {"<body>_displacement0", "m", "0", "initial displacement along the axis"},
    {"<body>_velocity0", "m/s", "0", "initial velocity: along the axis; free: x,y,z in the world"},
    {"<body>_torque", "N m", "0", "about the axis: a number, [ramp, VALUE, DURATION] or [table, FILE.csv]"},
    {"<body>_force", "N", "0", "along the axis: a number, [ramp, VALUE, DURATION] or [table, FILE.csv]"},
    {"<body>_rotation_motion", "rad", "",
     "prescribed rotation: [speed, VALUE], [spin_up, VALUE, DURATION] or [table, FILE.csv]"},
    {"<body>_translation_motion", "m", "",
     "prescribed translation: [speed, VALUE], [spin_up, VALUE, DURATION] or [table, FILE.csv]"},
    {"<body>_rotation_damping", "N m s", "0", "viscous damping about the axis"},
    {"<body>_rotation_friction", "N m", "0", "Coulomb friction about the axis"},
    {"<body>_rotation_friction_rate", "rad/s", "0", "speed at which friction is tanh(1) of its full value"},
    {"<body>_translation_damping", "N s/m", "0", "viscous damping along the axis"},
    {"<body>_translation_friction", "N", "0", "Coulomb friction along the axis"},
    {"<body>_translation_friction_rate", "m/s", "0", "speed at which friction is tanh(1) of its full value"},
    {"gravity", "m/s^2", "0,0,0", "acceleration of gravity in the world"},
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
    {"inertia", "-", "linear", "what the inertia keeps of the deformation: constant or linear"},
    {"analysis", "-", "dynamic", "dynamic"},
    {"ts_dt", "s", "", "time step"},
    {"ts_max_time", "s", "", "end of the simulation"},
    {"ts_alpha_radius", "-", "1", "spectral radius rho_inf of generalised-alpha, 1: no numerical damping"},
    {"output", "-", "", "result file to write (HDF5)"},
    {"output_every", "-", "1", "write every n-th step"},
};

OptionTable table() {
  OptionTable table = kOptions;
  const OptionTable markers = marker_table();
  table.insert(table.end(), markers.begin(), markers.end());
  return table;
}

body::Joint joint(const Options& options, const std::string& prefix) {
  body::Joint joint;
  joint.type = static_cast<body::JointType>(options.choice(prefix + "joint", body::joint_names()));
  joint.axis = options.vector(prefix + "axis");
  joint.point = options.vector(prefix + "point");
  joint.r_WB0 = options.vector(prefix + "position");
  joint.R_WB0 = rotation_matrix(options.vector(prefix + "rotation"));
  return joint;
}

// A body reduced free has no nodes that carry its frame.
void check_free_body(const dynamics::BodySetup& setup) {
  const bool modal = setup.body->basis == model::Basis::modal;
  if (!setup.body->floating || (modal && setup.joint.type == body::JointType::free)) return;
  require(modal || setup.joint.type == body::JointType::fixed, "body ", setup.name,
          " was reduced free with the full basis, which contains rigid motions: its joint must be fixed");
  print_item("warning", "body " + setup.name +
                            " was reduced free, but a joint holds its frame: no node is held, " +
                            "its mean motion is");
}

// kind: "rotation" or "translation"; load: "torque" or "force". Initial values are set already.
void set_axis(const Options& options, const std::string& prefix, const char* kind, const char* load_name,
              dynamics::Axis& axis) {
  const std::string name = prefix + kind;
  axis.load = signal(options, prefix + load_name);
  axis.damping = options.number(name + "_damping");
  axis.friction = options.number(name + "_friction");
  axis.friction_rate = options.number(name + "_friction_rate");
  if (!options.given(name + "_motion")) return;
  axis.drive = drive(options, name + "_motion", std::exchange(axis.s_0, 0));
}

// A number, or three where the joint takes a vector.
void set_rate(const Options& options, const std::string& name, double& scalar, Eigen::Vector3d& vector) {
  const std::size_t n = options.numbers(name).size();
  require(n == 1 || n == 3, "option -", name, ": must be one number, or three x,y,z for a free body");
  if (n == 3)
    vector = options.vector(name);
  else
    scalar = options.number(name);
}

model::ElasticBody read_or_make_body(const Options& options, const std::string& prefix) {
  if (options.given(prefix + "file")) {
    require(!options.given(prefix + "mass") && !options.given(prefix + "inertia"), "options -", prefix,
            "file and -", prefix, "mass, _inertia exclude each other");
    const model::ElasticBody body = io::read_body(options.text(prefix + "file"));
    return options.flag(prefix + "rigid") ? body::rigid_copy(body) : body;
  }
  require(options.given(prefix + "mass"), "option -", prefix,
          "file is missing: body file made by reduce (or give -", prefix, "mass and -", prefix,
          "inertia of a rigid body)");
  const std::vector<double> J = options.numbers(prefix + "inertia");
  require(J.size() == 6, "option -", prefix, "inertia: must be six numbers xx,yy,zz,xy,yz,xz (kg m^2)");
  Eigen::Matrix3d J_c;
  J_c << J[0], J[3], J[5], J[3], J[1], J[4], J[5], J[4], J[2];
  return body::rigid_body(options.number(prefix + "mass"), options.vector(prefix + "center"), J_c);
}

dynamics::BodySetup body_setup(const Options& options, const std::string& name) {
  const std::string prefix = name + "_";
  dynamics::BodySetup setup;
  setup.name = name;
  setup.joint = joint(options, prefix);
  setup.rotation.s_0 = options.number(prefix + "angle0");
  setup.translation.s_0 = options.number(prefix + "displacement0");
  set_rate(options, prefix + "omega0", setup.rotation.s_dot_0, setup.omega0);
  set_rate(options, prefix + "velocity0", setup.translation.s_dot_0, setup.velocity0);
  set_axis(options, prefix, "rotation", "torque", setup.rotation);
  set_axis(options, prefix, "translation", "force", setup.translation);
  model::ElasticBody body = read_or_make_body(options, prefix);
  change_body(options, prefix, body);
  setup.body = std::make_shared<model::ElasticBody>(std::move(body));
  check_free_body(setup);
  return setup;
}

dynamics::Environment environment(const Options& options) {
  return {static_cast<body::InertiaLevel>(options.choice("inertia", {"constant", "linear"})),
          options.vector("gravity")};
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
  options.reject_unknown(simulate_names(options));
  options.choice("analysis", {"dynamic"});
  const std::string output = options.text("output");
  const dynamics::TimeSettings time = time_settings(options);
  const std::vector<dynamics::PairSetup> pairs = pair_setups(options, names);
  const dynamics::Environment surroundings = environment(options);
  const dynamics::MarkerSetups markers = marker_setups(options);
  std::vector<dynamics::BodySetup> bodies;
  for (const std::string& name : names) bodies.push_back(body_setup(options, name));

  dynamics::System system(std::move(bodies), pairs, surroundings, markers);
  model::ResultHeader header = result_header(system);
  for (auto& body : header.bodies) {
    const std::string file = body.name + "_file";
    body.file = options.given(file) ? options.text(file) : "";
  }
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
          "bodies, joints, loads, contact -> result file", table(), run};
}

}  // namespace elastogear::app
