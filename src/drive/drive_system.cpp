#include "elastogear/drive/drive_system.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"
#include "elastogear/base/text.h"
#include "elastogear/drive/surface_compliance.h"
#include "elastogear/io/body_file.h"
#include "elastogear/model/fingerprint.h"

namespace elastogear::drive {
namespace {

using dynamics::BodySetup;
using Eigen::Vector3d;

// A gear in one run: whether it is held, what drives it and how fast it begins.
struct Part {
  const Member& member;
  std::vector<Bearing> bearings;
  bool held = false;   // at rest
  bool led = false;    // from position to position
  double torque = 0;   // N m, about its axis
  double omega_0 = 0;  // rad/s
};

Part part_of(const Drive& drive, const Operation& operation, std::size_t i) {
  const Member& member = drive.members[i];
  const bool moves = operation.analysis == Analysis::motion;
  const bool first = i == 0, last = i + 1 == drive.members.size() && !first;
  Part part{member, bearings_of(operation, i)};
  part.held = last && !moves;
  part.led = part.held && operation.analysis == Analysis::sweep;
  if (first) part.torque = operation.torque;
  if (last && moves) part.torque = -operation.torque / member.ratio;
  if (moves) part.omega_0 = operation.speed * member.ratio;
  return part;
}

// Says which stiffnesses the bearings of a gear need besides to hold it; empty where they hold it.
std::string lack_of(const Member& member, const std::vector<Bearing>& bearings) {
  double axial = 0, tilt = 0;
  std::vector<std::string> soft, lacks;
  for (const Bearing& b : bearings) {
    require(b.radial >= 0 && b.axial >= 0 && b.tilt >= 0, "bearing ", b.name, ": stiffness ", b.radial,
            " N/m radial, ", b.axial, " N/m axial, ", b.tilt,
            " N m/rad against tilting: the first must be positive, the others at least 0");
    if (b.radial == 0) soft.push_back(b.name);
    axial += b.axial;
    tilt += b.tilt + std::abs(b.at - bearings[0].at);
  }
  if (!soft.empty())
    lacks.push_back("radial stiffness is missing of " + join(soft, ", ") +
                    "; give it (radial), or a designation (catalogue)");
  if (axial == 0)
    lacks.emplace_back("none of them holds the gear along its axis; give one an axial stiffness (axial)");
  if (tilt == 0)
    lacks.emplace_back(
        "they do not keep the gear from tilting; give them different places (at), or one a "
        "stiffness against tilting (tilt)");
  return lacks.empty() ? "" : "bearings of " + member.name + ": " + join(lacks, ". Besides, ");
}

// Refuses bearings that leave a gear free to move or to tilt, with all that is missing, of all gears.
void require_held(const Drive& drive, const Operation& operation) {
  std::string lacks;
  for (std::size_t i = 0; i < drive.members.size(); ++i) {
    const std::vector<Bearing> bearings = bearings_of(operation, i);
    const std::string lack = bearings.empty() ? "" : lack_of(drive.members[i], bearings);
    if (!lack.empty()) lacks += (lacks.empty() ? "" : ". Also the ") + lack;
  }
  require(lacks.empty(), lacks);
}

Eigen::Matrix3d turned(const Member& member) {
  return rotation_matrix(member.rotation) * rotation_matrix({0, 0, member.angle});
}

// The axis is fixed. A joint has the member's angle for its coordinate; a fixed one is turned by it.
void set_joint(const Part& part, BodySetup& body) {
  const bool fixed = part.held && !part.led;
  body.joint.type = fixed ? body::JointType::fixed : body::JointType::revolute;
  body.joint.R_WB0 = fixed ? turned(part.member) : rotation_matrix(part.member.rotation);
  if (fixed) return;
  body.joint.axis = Vector3d::UnitZ();
  if (part.led) {
    body.rotation.drive = dynamics::speed_drive(part.member.angle, 0);
    return;
  }
  body.rotation.s_0 = part.member.angle;
  body.rotation.s_dot_0 = part.omega_0;
  if (part.torque != 0) body.rotation.load = dynamics::constant_signal(part.torque);
}

// turn: N m/rad, of a spring about the axis.
dynamics::BushingSetup bushing(const Member& member, const Bearing& b, double turn) {
  return {.name = b.name,
          .marker = {{}, {member.name, b.at == 0 ? model::kFrameMarker : b.name}},
          .law = {.k = {b.radial, b.radial, b.axial}, .k_r = {b.tilt, b.tilt, turn}},
          .axes = rotation_matrix(member.rotation)};
}

// torque: N m, which a held gear takes.
void set_bearings(const Part& part, double torque, BodySetup& body, dynamics::MarkerSetups& markers) {
  constexpr double kTurn = 1e-8;  // rad
  body.joint.type = body::JointType::free;
  body.joint.R_WB0 = turned(part.member);
  body.omega0 = {0, 0, part.omega_0};
  for (const Bearing& b : part.bearings) {
    const bool holds = part.held && &b == part.bearings.data();
    markers.bushings.push_back(bushing(part.member, b, holds ? std::abs(torque) / kTurn : 0));
  }
  if (part.torque == 0) return;
  markers.loads.push_back({.name = "torque_of_" + part.member.name,
                           .marker = {part.member.name, model::kFrameMarker},
                           .torque = {0, 0, part.torque},
                           .follows = true});
}

// m/s, in a motion of one pitch a second.
double fading_speed(const Drive& drive, const Operation& operation, double given) {
  constexpr double kFadingSpeed = 1e-3;  // of the pitch-line speed
  const double pitch = angular_pitch(drive), speed = std::abs(operation.speed);
  if (given <= 0) return kFadingSpeed * pitch * drive.members.front().toothing.r;
  return speed > 0 ? given * pitch / speed : given;
}

// rad for a pitch of the first gear; 0 for what is no gear of the drive.
double rate(const Drive& drive, const std::string& name) {
  for (const Member& member : drive.members)
    if (member.name == name) return angular_pitch(drive) * member.ratio;
  return 0;
}

}  // namespace

std::vector<Bearing> bearings_of(const Operation& operation, std::size_t member) {
  return member < operation.bearings.size() ? operation.bearings[member] : std::vector<Bearing>{};
}

model::RunInput run_input(const Drive& drive, const Operation& operation, double roll) {
  model::RunInput input{.analysis = operation.analysis,
                        .drive = model::DriveInput{roll, operation.torque, operation.speed}};
  for (const Member& member : drive.members)
    if (member.deviations || member.misaligned) input.inexact.push_back(member.name);
  return input;
}

DriveSystem drive_system(const Drive& drive, const Operation& operation) {
  require_held(drive, operation);
  DriveSystem system;
  for (std::size_t i = 0; i < drive.members.size(); ++i) {
    const Part part = part_of(drive, operation, i);
    BodySetup& body = system.bodies.emplace_back();
    body.name = part.member.name;
    body.joint.r_WB0 = part.member.position;
    part.bearings.empty() ? set_joint(part, body)
                          : set_bearings(part, operation.torque / part.member.ratio, body, system.markers);
  }
  contact::Settings exact;
  exact.surface = contact::ContactSurface::exact;
  exact.points = contact::SlavePoints::stations;
  exact.law = contact::ContactLaw::unilateral;
  for (const Pair& pair : drive.pairs)
    system.pairs.push_back({pair_name(drive, pair), {pair.first, pair.second}, exact});
  return system;
}

void add_bearing_markers(const std::vector<Bearing>& bearings, model::ElasticBody& body) {
  for (const Bearing& b : bearings) {
    if (b.at == 0) continue;
    require(b.name != model::kFrameMarker &&
                std::none_of(body.markers.begin(), body.markers.end(),
                             [&](const model::Marker& marker) { return marker.name == b.name; }),
            "bearing ", b.name, ": the gear's body has a marker of this name already; give it another name");
    model::Marker marker{b.name, {0, 0, b.at}};
    marker.Phi = model::SparseRows(6, body.n_q());
    body.markers.push_back(marker);
  }
}

Teeth teeth_of(const Member& member) {
  return {member.toothing, member.deviations, member.is_worm ? Layers::axial : Layers::transverse};
}

std::string take_body(const Member& member, const std::string& file, const std::vector<Bearing>& bearings,
                      BodySetup& body) {
  auto elastic = std::make_shared<model::ElasticBody>(io::read_body(file, io::BodyUse::motion));
  const std::string identity = model::fingerprint(*elastic);
  add_bearing_markers(bearings, *elastic);
  try {
    body.true_surface = std::make_shared<const contact::TrueSurface>(
        flank_surface(teeth_of(member), elastic->surface, false).surface);
  } catch (const Error& error) {
    fail(file, ": ", error.what());
  }
  body.surface_compliance = surface_compliance(file, elastic->surface);
  body.body = std::move(elastic);
  return identity;
}

dynamics::SlowMotion slow_motion(const Drive& drive, const Operation& operation, DriveSystem system,
                                 const dynamics::Environment& environment) {
  dynamics::SlowMotion motion{std::move(system.bodies), std::move(system.pairs), environment,
                              std::move(system.markers)};
  for (const BodySetup& body : motion.bodies) motion.rate.push_back(rate(drive, body.name));
  const std::size_t last = drive.members.size() - 1;
  const std::vector<Bearing> led = bearings_of(operation, last);
  for (const dynamics::BushingSetup& bushing : motion.markers.bushings) {
    const bool turns =
        std::any_of(led.begin(), led.end(), [&](const Bearing& b) { return b.name == bushing.name; });
    motion.bushing_rate.push_back(turns ? rate(drive, drive.members[last].name) : 0);
  }
  for (dynamics::PairSetup& pair : motion.pairs)
    if (contact::FrictionSettings& friction = pair.settings.friction; friction.mu > 0)
      friction.v_0 = fading_speed(drive, operation, friction.v_0);
  return motion;
}

double angular_pitch(const Drive& drive) { return 2 * std::numbers::pi / drive.members.front().toothing.z; }

}  // namespace elastogear::drive
