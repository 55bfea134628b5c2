#pragma once
// Contact patterns: the largest pressure over a run at each place of a flank, all teeth laid over each other.

#include <Eigen/Core>
#include <optional>
#include <string>

#include "elastogear/evaluation/contact.h"
#include "elastogear/evaluation/face_stations.h"

namespace elastogear::evaluation {

/// Place on a flank in its own coordinates.
struct FlankPlace {
  double profile = 0;  ///< m, length of roll of an involute, radius of other flanks
  double z = 0;        ///< m, along the axis
};
FlankPlace flank_place(const gear::Toothing& toothing, const Eigen::Vector3d& x_B);
/// Are the profile coordinates lengths of roll?
bool has_length_of_roll(const gear::Toothing& toothing);

struct ContactPattern {
  int side = 0;              ///< +1 left, -1 right
  Eigen::VectorXd profile;   ///< n_p, m, middles of the cells
  Eigen::VectorXd z;         ///< n_z, m
  Eigen::MatrixXd pressure;  ///< n_p x n_z, Pa, 0 where there was no contact
};

/// Pattern of gear g (0 or 1) on the flanks of one side; nothing where none of these is touched. A contact
/// covers half the way to the next position along the profile, `reach` (m), and to the next stations along
/// this gear's face.
std::optional<ContactPattern> contact_pattern(const ContactHistory& contacts, const Gear& gear, int g,
                                              int side, double reach, const FaceStations& stations);

/// Largest pressure of a run and its place.
struct PressurePeak {
  double pressure = 0;  ///< Pa
  int step = 0;
  FlankContact contact;
};
/// Nothing without contact.
std::optional<PressurePeak> largest_pressure(const ContactHistory& contacts);

}  // namespace elastogear::evaluation
