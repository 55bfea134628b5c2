#pragma once
// Stresses of the gears of a drive at the torques of its sweeps.

#include <string>
#include <vector>

#include "app/gear/drive.h"
#include "app/life/life_options.h"
#include "elastogear/io/stress_file.h"

namespace elastogear::app {

/// One torque of a sweep: a result file, or a stress file that recover wrote of it.
struct SweptTorque {
  std::string file;
  double torque = 0;       ///< N m, on the first gear; < 0 on the coast side
  bool recovered = false;  ///< a stress file
};

/// Files that the options name, or those that simulate wrote of the drive. Error naming what is missing and
/// the remedy.
std::vector<SweptTorque> swept_torques(const Options& options, const LifeSettings& settings);

/// The signed principal stresses of one node set over the positions of one sweep.
struct SweptStress {
  std::string body, set;
  std::vector<int> node;       ///< n, mesh numbers
  Eigen::Matrix3Xd X;          ///< 3 x n, m, body frame
  Eigen::VectorXd roll;        ///< n_t, pitches
  Eigen::MatrixXd stress;      ///< n x n_t, Pa
  Eigen::MatrixXd error = {};  ///< n x n_t, Pa, estimated by reduction, mesh and contact; or empty
};

/// The node sets that are wanted of bodies that are not rigid in the run, at one torque. Bodies without modes
/// do not tell the error of their mesh: that of their roots is then the one that `run` has found, if this is
/// its result. Error when the file does not hold them.
std::vector<SweptStress> read_stresses(const Options& options, const LifeSettings& settings,
                                       const SweptTorque& at);

/// The member's body file: that of the options, or of the result. Empty: there is none.
std::string body_file_of(const Options& options, const DriveMember& member, const SweptTorque& at);

}  // namespace elastogear::app
