#include "app/tables/body_options.h"

#include <utility>

#include "app/console/console.h"
#include "app/options/rows.h"
#include "app/surface/true_surface.h"
#include "app/tables/initial_state.h"
#include "app/tables/marker_options.h"
#include "app/tables/motion.h"
#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"
#include "elastogear/base/tensor.h"
#include "elastogear/body/rigid.h"
#include "elastogear/drive/surface_compliance.h"
#include "elastogear/io/body_file.h"
#include "elastogear/model/fingerprint.h"

namespace elastogear::app {
namespace {

using Setup = dynamics::BodySetup;
using body::Joint, dynamics::Axis;

// A body comes from its file, or is rigid with mass and inertia from options.
struct BodySource {
  std::string file = {};
  bool rigid = false, residual = true;
  double mass = 0;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  std::vector<double> inertia = {};
};

// A number, or three where the joint takes a vector.
void set_rate(const Options& options, const std::string& name, double& scalar, Eigen::Vector3d& vector) {
  if (!options.given(name)) return;
  const std::size_t n = options.numbers(name).size();
  require(n == 1 || n == 3, "option -", name, ": must be one number, or three x,y,z for a free body");
  scalar = 0;
  vector.setZero();
  if (n == 3)
    vector = options.vector(name);
  else
    scalar = options.number(name);
}

const Rows<BodySource> kSourceRows = {
    {"bodies", "-", "", "names of the bodies; each has its own <body>_... keys"},
    {"<body>_file", &BodySource::file, "-", "body file made by reduce; without one give mass and inertia"},
    {"<body>_rigid", &BodySource::rigid, "-", "leave out the elastic coordinates of the file"},
    {"<body>_residual", &BodySource::residual, "-",
     "let contact feel the static responses that the file holds beside its modes (reduce -basis "
     "modal_residual)"},
    {"<body>_mass", &BodySource::mass, "kg", "rigid body without a file: mass", kDependent},
    {"<body>_center", &BodySource::center, "m",
     "rigid body without a file: centre of mass in the body frame"},
    {"<body>_inertia", &BodySource::inertia, "kg m^2",
     "rigid body without a file: xx,yy,zz,xy,yz,xz about the centre of mass"},
};

const Rows<Setup> kBodyRows = {
    {"<body>_position", in(&Setup::joint, &Joint::r_WB0), "m", "origin of the body frame in the world"},
    {"<body>_rotation", "rad", "0,0,0", "rotation vector from the body frame to the world",
     [](auto& o, auto& name, auto& s) {
       if (o.given(name)) s.joint.R_WB0 = rotation_matrix(o.vector(name));
     }},
    {"<body>_joint", in(&Setup::joint, &Joint::type), body::joint_names(),
     "fixed, revolute, prismatic, cylindrical, spherical or free"},
    {"<body>_axis", in(&Setup::joint, &Joint::axis), "-", "direction of the joint's axis in the body frame"},
    {"<body>_point", in(&Setup::joint, &Joint::point), "m",
     "point of the axis, or centre of a spherical joint, in the body frame"},
    {"<body>_angle0", in(&Setup::rotation, &Axis::s_0), "rad", "initial angle about the axis"},
    {"<body>_omega0", "rad/s", "0",
     "initial angular velocity: about the axis; free, spherical: x,y,z in the body frame",
     [](auto& o, auto& name, auto& s) { set_rate(o, name, s.rotation.s_dot_0, s.omega0); }},
    {"<body>_displacement0", in(&Setup::translation, &Axis::s_0), "m", "initial displacement along the axis"},
    {"<body>_velocity0", "m/s", "0", "initial velocity: along the axis; free: x,y,z in the world",
     [](auto& o, auto& name, auto& s) { set_rate(o, name, s.translation.s_dot_0, s.velocity0); }},
    {"<body>_torque", "N m", "0", "about the axis: a number, [ramp, VALUE, DURATION] or [table, FILE.csv]",
     [](auto& o, auto& name, auto& s) {
       if (o.given(name)) s.rotation.load = signal(o, name);
     }},
    {"<body>_force", "N", "0", "along the axis: a number, [ramp, VALUE, DURATION] or [table, FILE.csv]",
     [](auto& o, auto& name, auto& s) {
       if (o.given(name)) s.translation.load = signal(o, name);
     }},
    {"<body>_rotation_motion", "rad", "",
     "prescribed rotation, from the initial one on: [speed, VALUE], [spin_up, VALUE, DURATION] or [table, "
     "FILE.csv]"},
    {"<body>_translation_motion", "m", "",
     "prescribed translation, from the initial one on: [speed, VALUE], [spin_up, VALUE, DURATION] or [table, "
     "FILE.csv]"},
    {"<body>_rotation_damping", in(&Setup::rotation, &Axis::damping), "N m s",
     "viscous damping about the axis"},
    {"<body>_rotation_friction", in(&Setup::rotation, &Axis::friction), "N m",
     "Coulomb friction about the axis"},
    {"<body>_rotation_friction_rate", in(&Setup::rotation, &Axis::friction_rate), "rad/s",
     "speed at which friction is tanh(1) of its full value"},
    {"<body>_translation_damping", in(&Setup::translation, &Axis::damping), "N s/m",
     "viscous damping along the axis"},
    {"<body>_translation_friction", in(&Setup::translation, &Axis::friction), "N",
     "Coulomb friction along the axis"},
    {"<body>_translation_friction_rate", in(&Setup::translation, &Axis::friction_rate), "m/s",
     "speed at which friction is tanh(1) of its full value"},
};

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

// A prescribed motion starts from the axis's initial value.
void set_drive(const Options& options, const std::string& name, Axis& axis) {
  if (options.given(name))
    axis.drive = drive(options, name, std::exchange(axis.s_0, 0));
  else if (axis.drive)
    axis.drive->s_0 = std::exchange(axis.s_0, 0);
}

// identity: of the file's contents, whatever options leave out of them.
model::ElasticBody read_or_make_body(const Options& options, const std::string& name, std::string& identity) {
  const std::string prefix = name + "_";
  BodySource source;
  read_rows(options, kSourceRows, source, name);
  if (!source.file.empty()) {
    require(!options.given(prefix + "mass") && !options.given(prefix + "inertia"), "options -", prefix,
            "file and -", prefix, "mass, _inertia exclude each other");
    model::ElasticBody body = io::read_body(source.file, io::BodyUse::motion);
    identity = model::fingerprint(body);
    if (source.rigid) body = body::rigid_copy(body);
    if (!source.residual) body.flexibility = {};
    return body;
  }
  require(options.given(prefix + "mass"), "option -", prefix,
          "file is missing: body file made by reduce (or give -", prefix, "mass and -", prefix,
          "inertia of a rigid body)");
  const std::vector<double>& J = source.inertia;
  require(J.size() == 6, "option -", prefix, "inertia: must be six numbers xx,yy,zz,xy,yz,xz (kg m^2)");
  return body::rigid_body(source.mass, source.center, symmetric(Vector6(J.data())));
}

}  // namespace

OptionTable body_table() {
  OptionTable table = table_of(kSourceRows, kBodyRows);
  const OptionTable surface = true_surface_table();
  table.insert(table.end(), surface.begin(), surface.end());
  return table;
}

dynamics::BodySetup body_setup(const Options& options, const BodyStart& start, KnownBodies& known) {
  Setup setup = start.setup;
  const std::string& name = setup.name;
  if (setup.rotation.drive) setup.rotation.s_0 = setup.rotation.drive->s_0;
  read_rows(options, kBodyRows, setup, name);
  const body::JointType joint = setup.joint.type;
  require(
      !options.given(name + "_axis") || body::has_rotation_axis(joint) || body::has_translation_axis(joint),
      "option -", name, "_axis: a ", body::joint_names()[static_cast<std::size_t>(joint)],
      " joint has no axis; revolute, prismatic and cylindrical joints have");
  set_initial_state(options, setup);
  set_drive(options, name + "_rotation_motion", setup.rotation);
  set_drive(options, name + "_translation_motion", setup.translation);
  KnownBody& own = known[name];
  if (!own.body) {
    model::ElasticBody body = read_or_make_body(options, name, own.identity);
    change_body(options, name, body);
    drive::add_bearing_markers(start.bearings, body);
    own.body = std::make_shared<model::ElasticBody>(std::move(body));
  }
  setup.body = own.body;
  set_relaxed_state(options, setup);
  if (const std::string input = true_surface_input(options, name);
      !own.true_surface || own.true_surface_input != input) {
    own.true_surface = true_surface(options, name, start.member, setup.body->surface);
    own.true_surface_input = input;
  }
  setup.true_surface = own.true_surface;
  if (own.true_surface && options.given(name + "_file")) {
    if (!own.surface_compliance)
      own.surface_compliance = drive::surface_compliance(options.text(name + "_file"), setup.body->surface);
    setup.surface_compliance = *own.surface_compliance;
  }
  check_free_body(setup);
  return setup;
}

}  // namespace elastogear::app
