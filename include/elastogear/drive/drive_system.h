#pragma once
// The system that a drive under load is: gears on joints or in bearings, what drives and holds them, and
// contact of their flanks.

#include <string>
#include <vector>

#include "elastogear/drive/drive.h"
#include "elastogear/drive/flank_surface.h"
#include "elastogear/dynamics/sweep.h"
#include "elastogear/model/run_input.h"

namespace elastogear::drive {

/// A bearing between a gear and the ground, in which the gear turns freely about its axis.
struct Bearing {
  std::string name;
  double at = 0;                 ///< m, along the axis, in the gear's body frame
  double radial = 0, axial = 0;  ///< N/m
  double tilt = 0;               ///< N m/rad, against tilting
};

using model::Analysis;

/// How a drive is run.
struct Operation {
  Analysis analysis = Analysis::sweep;
  double torque = 0;  ///< N m, on the first gear about its axis
  double speed = 0;   ///< rad/s, of the first gear about its axis at the start of a motion
  std::vector<std::vector<Bearing>> bearings = {};  ///< of each member; none: its axis is fixed
};

/// The bearings of a member; none: its axis is fixed.
std::vector<Bearing> bearings_of(const Operation& operation, std::size_t member);

/// What result files say of a drive that is run so and begins at this roll angle (pitches).
model::RunInput run_input(const Drive& drive, const Operation& operation, double roll);

/// Bodies stand in the members' order and lack what only a reduced body knows: see take_body().
struct DriveSystem {
  std::vector<dynamics::BodySetup> bodies = {};
  std::vector<dynamics::PairSetup> pairs = {};
  dynamics::MarkerSetups markers = {};
};

/// The torque drives the first gear. At rest the last gear is held: by its joint, in a sweep led from
/// position to position, and in bearings by a spring about its axis that the torque turns by 1e-8 rad. In
/// motion it carries the torque of a drive without losses, and all gears begin with the speeds of their
/// ratios. Throws Error for bearings that leave a gear free to move or to tilt.
DriveSystem drive_system(const Drive& drive, const Operation& operation);

/// Adds a marker at each bearing that is not at the origin of the body frame. Throws Error where there is one
/// of its name.
void add_bearing_markers(const std::vector<Bearing>& bearings, model::ElasticBody& body);

/// The teeth of a gear, whose exact flanks stand behind the faces of its mesh.
Teeth teeth_of(const Member& member);

/// Gives a body of the system what its body file holds, markers at its bearings and its exact flanks. Returns
/// the identity of the file, model::fingerprint. Throws Error where the file's surface is not that of the
/// member's mesh.
std::string take_body(const Member& member, const std::string& file, const std::vector<Bearing>& bearings,
                      dynamics::BodySetup& body);

/// The system of a drive at roll 0 as a sweep takes it, whose p are pitches of the first gear. Friction fades
/// below friction.v_0 (m/s): of a motion at operation.speed, or at one pitch a second where that is 0. Where
/// friction.v_0 is 0 that is a thousandth of the pitch-line speed.
dynamics::SlowMotion slow_motion(const Drive& drive, const Operation& operation, DriveSystem system,
                                 const dynamics::Environment& environment = {});

/// rad, one pitch of the first gear.
double angular_pitch(const Drive& drive);

}  // namespace elastogear::drive
