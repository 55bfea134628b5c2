// The bodies, joints, bearings and loads of a drive's simulation.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "app/gear/drive_options.h"
#include "app/options/rows.h"
#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"

namespace elastogear::app {
namespace {

// Stiffness of the bearings of one gear together, at the origin of its body frame.
struct Bearing {
  double radial = 0, axial = 0;  // N/m
  double tilt = 0;               // N m/rad
};

const Rows<Bearing> kBearingRows = {
    {"<gear>_bearing_radial", &Bearing::radial, "N/m",
     "drive: radial stiffness of the gear's bearings together; without one its axis stands fast",
     kDependent | kPositive},
    {"<gear>_bearing_axial", &Bearing::axial, "N/m",
     "drive: axial stiffness of the bearings (default: the radial one)", kDependent | kPositive},
    {"<gear>_bearing_tilt", &Bearing::tilt, "N m/rad",
     "drive: stiffness of the bearings against tilting (default: that of the radial one spread over the "
     "face)",
     kDependent | kPositive},
};

std::string digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

std::string triple(const Eigen::Vector3d& v) {
  return digits(v[0]) + "," + digits(v[1]) + "," + digits(v[2]);
}

std::string rotation_vector(const Eigen::Matrix3d& R) {
  const Eigen::AngleAxisd rotation(R);
  return triple(rotation.angle() * rotation.axis());
}

std::optional<Bearing> bearing(const Options& options, const DriveMember& member) {
  const std::string radial = member.name + "_bearing_radial";
  for (const auto& row : kBearingRows) {
    const std::string name = with_word(row.spec.name, member.name);
    require(!options.given(name) || options.given(radial), options.label(name), ": needs ", radial, ", too");
  }
  if (!options.given(radial)) return {};
  Bearing b;
  read_rows(options, kBearingRows, b, member.name);
  if (b.axial == 0) b.axial = b.radial;
  if (b.tilt == 0) b.tilt = b.radial * member.width * member.width / 12;
  return b;
}

// A gear of the drive in one run: whether it is held, and its torque and speed.
struct Part {
  const DriveMember& member;
  bool held = false;   // at rest
  bool led = false;    // from position to position
  double torque = 0;   // N m, about its axis
  double omega_0 = 0;  // rad/s
};

Eigen::Matrix3d turned(const DriveMember& member) {
  return rotation_matrix(member.rotation) * rotation_matrix({0, 0, member.angle});
}

// The axis stands fast. With the joint's coordinate at the member's angle, or, held there, turned by it.
void set_joint(Options& options, const Part& part) {
  const std::string& name = part.member.name;
  const bool fixed = part.held && !part.led;
  options.set_default(name + "_joint", fixed ? "fixed" : "revolute");
  options.set_default(name + "_rotation",
                      fixed ? rotation_vector(turned(part.member)) : triple(part.member.rotation));
  if (fixed) return;
  if (part.led) options.set_default(name + "_rotation_motion", "speed,0");
  options.set_default(name + "_axis", "0,0,1");
  options.set_default(name + "_angle0", digits(part.member.angle));
  if (part.torque != 0) options.set_default(name + "_torque", digits(part.torque));
  if (part.omega_0 != 0) options.set_default(name + "_omega0", digits(part.omega_0));
}

// A free body on a bushing that lets it turn about its axis; a held one is kept by a stiff spring there, in
// which the whole torque of the drive turns it by kTurn.
void set_bearing(Options& options, const Part& part, const Bearing& b, double torque) {
  constexpr double kTurn = 1e-8;  // rad
  const std::string &name = part.member.name, bushing = bearing_name(part.member), load = "torque_of_" + name;
  options.set_default(name + "_joint", "free");
  options.set_default(name + "_rotation", rotation_vector(turned(part.member)));
  if (part.omega_0 != 0) options.set_default(name + "_omega0", triple({0, 0, part.omega_0}));
  options.append("bushings", bushing);
  options.set_default(bushing + "_markers", "ground," + name + ".frame");
  options.set_default(bushing + "_axes", rotation_vector(rotation_matrix(part.member.rotation)));
  options.set_default(bushing + "_stiffness", triple({b.radial, b.radial, b.axial}));
  options.set_default(bushing + "_rotational_stiffness",
                      triple({b.tilt, b.tilt, part.held ? std::abs(torque) / kTurn : 0}));
  if (part.torque == 0) return;
  options.append("loads", load);
  options.set_default(load + "_marker", name + ".frame");
  options.set_default(load + "_frame", "body");
  options.set_default(load + "_torque", triple({0, 0, part.torque}));
}

void set_parts(Options& options, const Drive& drive, double sense) {
  const bool moves = options.text("analysis") == "dynamic", sweeps = options.text("analysis") == "sweep";
  const double torque = sense * options.number("torque"), speed = sense * options.number("speed");
  const bool loaded = torque != 0 || options.given("loads") || options.given("gravity") ||
                      !options.placeholder_values("<body>_torque").empty();
  require(moves || loaded, "option -torque is missing: on the first gear, as in 'torque: 300 N m'");
  for (const DriveMember& member : drive.members) {
    const bool first = &member == &drive.members.front(), last = &member == &drive.members.back();
    Part part{member, last && !first && !moves, last && !first && sweeps};
    if (first) part.torque = torque;
    if (last && !first && moves) part.torque = -torque / member.ratio;
    if (moves) part.omega_0 = speed * member.ratio;
    options.set_default(member.name + "_position", triple(member.position));
    const auto b = bearing(options, member);
    b ? set_bearing(options, part, *b, torque / member.ratio) : set_joint(options, part);
  }
}

}  // namespace

std::string bearing_name(const DriveMember& member) { return "bearing_of_" + member.name; }

OptionTable bearing_table() { return table_of(kBearingRows); }

Options with_system(Options options, const Drive& drive) {
  std::string bodies, pairs;
  for (const DriveMember& member : drive.members) {
    bodies += (bodies.empty() ? "" : ",") + member.name;
    options.set_default(member.name + "_file", body_file(options, member));
  }
  for (const DrivePair& pair : drive.pairs)
    pairs +=
        (pairs.empty() ? "" : ",") + drive.members[pair.first].name + ":" + drive.members[pair.second].name;
  options.set_default("bodies", bodies);
  options.set_default("contact_pairs", pairs);
  options.set_default("contact_surface", "exact");
  // Exact flanks meet where their gap is least, between the nodes of the coarsest mesh.
  if (!options.given("contact_two_pass")) options.set_default("contact_points", "minima");
  options.set_default("analysis", "static");
  options.set_default("output", drive_stem(options) + "_result.h5");
  set_parts(options, drive, options.choice("side", {"drive", "coast"}) == 0 ? 1 : -1);
  return options;
}

}  // namespace elastogear::app
