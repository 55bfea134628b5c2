#pragma once
// All that is read off one pair of gears over a run, as items of an evaluation file (docs/evaluation.md).

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "elastogear/evaluation/contact.h"
#include "elastogear/io/evaluation_file.h"
#include "elastogear/io/stress_file.h"

namespace elastogear::evaluation {

/// A pair of gears at n_t roll angles, or over a run in time.
struct PairOfRun {
  std::array<Gear, 2> gear;
  Eigen::VectorXd time = {};       ///< n_t, s, of a run in time; empty: positions of a sweep
  Eigen::VectorXd roll;            ///< n_t, pitches, of the drive's first gear
  int first_teeth = 1;             ///< of the drive's first gear
  double sense = 1;                ///< +1: the drive's first gear drives counter-clockwise; -1: clockwise
  double turning = 1;              ///< +1: it turns counter-clockwise, as in every sweep; -1: clockwise
  double speed = 0;                ///< rad/s, > 0, of the drive's first gear; 0: not known
  ContactHistory contacts;         ///< n_t
  Eigen::Matrix3Xd force, torque;  ///< 3 x n_t, N, N m about the world origin, on the second gear, world
  double friction = 0;             ///< coefficient of friction that contact forces have in them
  int slave_side = 0;              ///< which gear's nodes come into contact, or owns strips of contact
  int strips = 0;                  ///< of contact over the face; 0: none
  std::array<double, 2> compliance = {};  ///< 1/Pa, (1 - nu^2) / E behind the flanks; 0: not known
  bool by_hertz = false;                  ///< are the pressures of the contacts those by H. Hertz?
  Eigen::VectorXd unloaded = {};          ///< n_t, m, transmission error without load; empty: not known
  std::array<std::optional<io::StressSet>, 2> root = {};  ///< stresses at the roots of both gears
};

/// What is read off.
struct PairEvaluation {
  std::vector<io::EvaluationItem> items;  ///< paths below the pair: "transmission_error/mean"
  Eigen::VectorXd error;                  ///< n_t, m, transmission error
  Eigen::VectorXd force;                  ///< n_t, N, moment on the second gear over the radius of the errors

  /// Those of the item at this path. Throws Error where there is none.
  const std::vector<double>& values(const std::string& path) const;
};

/// Where the elasticity behind the flanks is known each contact takes the half width of its patch by H.
/// Hertz, and on parallel axes the pressure there: that of the line load at its station of the face.
void take_hertz(PairOfRun& pair);

/// Throws Error where the run has no times.
PairEvaluation evaluate(const PairOfRun& pair);

/// What is known beside another transmission error, without load (n_t, m), at the same roll angles: that, and
/// the secant stiffness, Eq. (10.4). width: m.
std::vector<io::EvaluationItem> unloaded_items(const PairEvaluation& pair, const Eigen::VectorXd& unloaded,
                                               double width);

/// The tangent stiffness between two loads at the same roll angles, Eq. (10.4), as items. width: m.
std::vector<io::EvaluationItem> tangent_stiffness(const PairEvaluation& pair, const PairEvaluation& other,
                                                  double width);

/// Transmission errors of the pair, m.
Eigen::VectorXd transmission_error(const PairOfRun& pair);

/// Roll angles of a run in time by its drive's first gear, pitches; roll: where it starts.
Eigen::VectorXd roll_of_run(const Gear& first, double roll);

/// Order spectrum of a signal of the run as items below `path`.
std::vector<io::EvaluationItem> spectrum_items(const PairOfRun& pair, const std::string& path,
                                               const Eigen::VectorXd& signal, const std::string& unit);

/// m, over which the faces of both gears stand beside each other as they are mounted; where axes cross, width
/// of the narrower gear.
double common_width(const PairOfRun& pair);

}  // namespace elastogear::evaluation
