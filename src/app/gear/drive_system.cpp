// The bodies, joints, bearings and loads of a drive's simulation.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/gear/drive_options.h"
#include "app/input/column_table.h"
#include "app/options/rows.h"
#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"

namespace elastogear::app {
namespace {

// Stiffness of one bearing, or of those of one gear together.
struct Bearing {
  double at = 0;                 // m, along the axis, in the gear's body frame
  double radial = 0, axial = 0;  // N/m
  double tilt = 0;               // N m/rad
};

// Options of the stiffness that all bearings of a gear have together, at the origin of its body frame.
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

const Rows<Bearing> kOneBearingRows = {
    {"<gear>_bearings", "-", "", "drive: names of the gear's bearings; each has its own <bearing>_... keys"},
    {"bearing_catalogue", "-", "",
     "drive: CSV file of rolling bearings: a line for each, designation, radial and axial stiffness (N/m) "
     "and "
     "that against tilting (N m/rad)"},
    {"<bearing>_at", &Bearing::at, "m",
     "drive: place of the bearing along the gear's axis, from the middle of the teeth"},
    {"<bearing>_catalogue", "-", "", "drive: designation in bearing_catalogue whose stiffness it has"},
    {"<bearing>_radial", &Bearing::radial, "N/m", "drive: radial stiffness of the bearing", kDependent},
    {"<bearing>_axial", &Bearing::axial, "N/m",
     "drive: axial stiffness of the bearing (default: 0, or that of the catalogue)", kDependent},
    {"<bearing>_tilt", &Bearing::tilt, "N m/rad",
     "drive: stiffness of the bearing against tilting (default: 0, or that of the catalogue)", kDependent},
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

// By the bushing that stands for each.
using Bearings = std::vector<std::pair<std::string, Bearing>>;

Bearing all_bearings(const Options& options, const DriveMember& member) {
  Bearing b;
  read_rows(options, kBearingRows, b, member.name);
  if (b.axial == 0) b.axial = b.radial;
  if (b.tilt == 0) b.tilt = b.radial * member.width * member.width / 12;
  return b;
}

Bearing in_catalogue(const std::string& file, const std::string& designation) {
  ColumnTable table(file);
  while (table.next()) {
    if (table.text(0) != designation) continue;
    if (table.n_columns() != 4)
      table.fail_here(
          "must be a designation, radial and axial stiffness (N/m) and that against tilting (N m/rad)");
    return {.radial = table.number(1, "N/m"),
            .axial = table.number(2, "N/m"),
            .tilt = table.number(3, "N m/rad")};
  }
  fail(file, ": has no line of bearing '", designation, "'");
}

Bearing one_bearing(const Options& options, const std::string& name) {
  Bearing b;
  const std::string designation = name + "_catalogue";
  if (options.given(designation)) {
    require(options.given("bearing_catalogue"), options.label(designation), ": needs bearing_catalogue, too");
    b = in_catalogue(options.text("bearing_catalogue"), options.text(designation));
  }
  read_rows(options, kOneBearingRows, b, name);
  require(b.radial > 0 && b.axial >= 0 && b.tilt >= 0, "bearing ", name, ": stiffness ", b.radial,
          " N/m radial, ", b.axial, " N/m axial, ", b.tilt,
          " N m/rad against tilting: the first must be positive, the others at least 0; give ", name,
          "_radial or ", designation);
  return b;
}

// Refuses bearings that together leave a gear free along its axis or free to tilt.
void require_held(const DriveMember& member, const Bearings& bearings) {
  double axial = 0, tilt = 0;
  for (const auto& [name, b] : bearings) {
    axial += b.axial;
    tilt += b.tilt + std::abs(b.at - bearings[0].second.at);
  }
  const std::string all = member.name + "_bearings: ";
  require(axial > 0, all, "none of them holds the gear along its axis; give one <bearing>_axial");
  require(tilt > 0, all,
          "they do not keep the gear from tilting; give them different places by <bearing>_at, or one "
          "<bearing>_tilt");
}

// None: the gear's axis stands fast.
Bearings bearings(const Options& options, const DriveMember& member) {
  const std::string radial = member.name + "_bearing_radial", list = member.name + "_bearings";
  for (const auto& row : kBearingRows) {
    const std::string name = with_word(row.spec.name, member.name);
    require(!options.given(name) || options.given(radial), options.label(name), ": needs ", radial, ", too");
  }
  require(!options.given(radial) || !options.given(list), options.label(radial), ": the gear has ", list,
          ", too; give one of the two");
  if (options.given(radial)) return {{"bearing_of_" + member.name, all_bearings(options, member)}};
  Bearings all;
  if (!options.given(list)) return all;
  for (const std::string& name : options.list(list)) all.emplace_back(name, one_bearing(options, name));
  if (!all.empty()) require_held(member, all);
  return all;
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

// Bushings let a gear turn about its axis; `turn` (N m/rad) keeps it from that.
void set_bushing(Options& options, const DriveMember& member, const std::string& name, const Bearing& b,
                 double turn) {
  std::string marker = member.name + ".frame";
  if (b.at != 0) {
    marker = member.name + "." + name;
    options.append(member.name + "_points", name + "," + triple({0, 0, b.at}));
  }
  options.append("bushings", name);
  options.set_default(name + "_markers", "ground," + marker);
  options.set_default(name + "_axes", rotation_vector(rotation_matrix(member.rotation)));
  options.set_default(name + "_stiffness", triple({b.radial, b.radial, b.axial}));
  options.set_default(name + "_rotational_stiffness", triple({b.tilt, b.tilt, turn}));
}

// A free body in its bearings; a held one is kept by a stiff spring at the first of them, in which the whole
// torque of the drive turns it by kTurn.
void set_bearings(Options& options, const Part& part, const Bearings& all, double torque) {
  constexpr double kTurn = 1e-8;  // rad
  const std::string &name = part.member.name, load = "torque_of_" + name;
  options.set_default(name + "_joint", "free");
  options.set_default(name + "_rotation", rotation_vector(turned(part.member)));
  if (part.omega_0 != 0) options.set_default(name + "_omega0", triple({0, 0, part.omega_0}));
  for (const auto& [bushing, b] : all) {
    const bool holds = part.held && bushing == all[0].first;
    set_bushing(options, part.member, bushing, b, holds ? std::abs(torque) / kTurn : 0);
  }
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
    // A prescribed motion takes no load and begins with its own speed.
    if (moves && options.given(member.name + "_rotation_motion")) part.torque = part.omega_0 = 0;
    options.set_default(member.name + "_position", triple(member.position));
    const Bearings all = bearings(options, member);
    all.empty() ? set_joint(options, part) : set_bearings(options, part, all, torque / member.ratio);
  }
}

// Exact flanks meet where their gap is least, between the nodes of the coarsest mesh, and do not enter each
// other there; bodies without residual flexibility do not either. What belongs to a penalty asks for one.
bool asks_for_penalty(const Options& options) {
  if (options.text("contact_law") != "auto") return options.text("contact_law") == "penalty";
  for (const char* name : {"contact_stiffness", "contact_damping", "contact_hysteresis"})
    if (options.given(name)) return true;
  return false;
}

}  // namespace

std::vector<std::string> bearing_names(const Options& options, const DriveMember& member) {
  std::vector<std::string> names;
  for (const auto& [name, bearing] : bearings(options, member)) names.push_back(name);
  return names;
}

OptionTable bearing_table() { return table_of(kBearingRows, kOneBearingRows); }

Options with_system(Options options, const Drive& drive) {
  std::string bodies, pairs;
  for (const DriveMember& member : drive.members) {
    bodies += (bodies.empty() ? "" : ",") + member.name;
    options.set_default(member.name + "_file", body_file(options, member));
  }
  for (const DrivePair& pair : drive.pairs) pairs += (pairs.empty() ? "" : ",") + pair_name(drive, pair);
  options.set_default("bodies", bodies);
  options.set_default("contact_pairs", pairs);
  options.set_default("contact_surface", "exact");
  if (!options.given("contact_two_pass") && !options.given("contact_points") && !asks_for_penalty(options)) {
    options.set("contact_points", "stations");
    if (options.text("contact_law") == "auto") options.set("contact_law", "unilateral");
  }
  options.set_default("analysis", "static");
  options.set_default("output", drive_stem(options) + "_result.h5");
  set_parts(options, drive, drive_start(options).coasts ? -1 : 1);
  return options;
}

}  // namespace elastogear::app
