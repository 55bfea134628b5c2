#pragma once
// The input of a run that its result and stress files keep for evaluation, fatigue life and time axes. SI
// units.

#include <optional>
#include <string>
#include <vector>

namespace elastogear::model {

/// relaxation: a motion whose velocities are set to zero at each peak of the kinetic energy, until all rests.
/// sweep: equilibria of a drive over its roll angles.
enum class Analysis { motion, equilibrium, relaxation, sweep };
/// "dynamic", "static", "relax", "sweep"; in the order of Analysis.
const std::vector<std::string>& analysis_names();

/// The drive of a run. Torque and speed are those of the first gear about its axis, in a drive's sense of
/// side drive > 0, of side coast < 0.
struct DriveInput {
  double roll = 0;    ///< pitches by which the first gear is turned at the start
  double torque = 0;  ///< N m
  double speed = 0;   ///< rad/s, at the start of a motion
};

struct RunInput {
  Analysis analysis = Analysis::motion;
  bool creeps = false;  ///< in equilibrium: under a load that was put on at time 0, in place of a growing one
  std::optional<DriveInput> drive = {};   ///< nothing: a system of bodies
  std::vector<std::string> inexact = {};  ///< bodies with modified or deviating flanks, or misaligned
};

}  // namespace elastogear::model
