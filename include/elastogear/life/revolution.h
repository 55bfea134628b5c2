#pragma once
// Stress of the nodes of a gear over whole revolutions, from a sweep over some pitches (docs/life.md).
//
// A mesh of gears without deviations repeats from pitch to pitch: what a node of one tooth bears at the roll
// angle xi, the same node of the next tooth bears at xi + 1. The stresses of all teeth over one pitch, laid
// behind each other, are those of each tooth over a revolution, its unloaded rest included.

#include <Eigen/Core>
#include <string>
#include <vector>

namespace elastogear::life {

/// Nodes that take each other's places when the gear turns by its pitches.
struct Orbits {
  Eigen::MatrixXi node;  ///< z x n / z: column by column the nodes, by local number; row j is row 0 turned by
                         ///< j pitches about +z
};

/// Sorts the nodes X (3 x n, m, axis z) of a gear with z teeth. name: of the set, for errors. Error naming a
/// node without an image within `tolerance` (m): the mesh does not repeat from tooth to tooth.
Orbits find_orbits(const std::string& name, const Eigen::Matrix3Xd& X, int z, double tolerance);

/// The positions of a sweep: evenly spaced over whole pitches, end excluded.
struct Sweep {
  int pitches = 0;    ///< whole ones that it goes over
  int per_pitch = 0;  ///< positions
};

/// Error unless the roll angles (pitches) are positions of a sweep. file: that they come from.
Sweep find_sweep(const std::string& file, const Eigen::VectorXd& roll);

/// Histories of the gear over revolutions of whole pitches.
struct Revolutions {
  int count = 1;          ///< that a history goes over
  bool laid = true;       ///< from the first pitch of the sweep; otherwise it goes over revolutions
  std::vector<int> node;  ///< m, local numbers of the nodes whose histories these are
  std::vector<std::vector<int>> of;  ///< m, the nodes that each of them stands for
  Eigen::MatrixXd stress;            ///< n_t x m, Pa
  double difference = 0;             ///< Pa, largest between what teeth bear at the same place of a pitch
};

/// stress: n x n_t, Pa, one value for each node and position. z: teeth; sense: +1 when the gear turns about
/// +z as the roll angle grows, else -1. Sweeps over whole revolutions of the gear are taken as they are; of
/// shorter ones the first pitch is laid behind itself. Error as find_orbits.
Revolutions over_revolutions(const std::string& name, const Eigen::MatrixXd& stress,
                             const Eigen::Matrix3Xd& X, const Sweep& sweep, int z, int sense);

/// The principal stress of largest size with its sign, Pa, n x n_t, of a 6 n x n_t history with the rows
/// xx yy zz xy yz xz of each node.
Eigen::MatrixXd signed_principal(const Eigen::MatrixXd& stress);

/// Stresses whose sizes are larger by errors >= 0.
Eigen::MatrixXd enlarged(const Eigen::MatrixXd& stress, const Eigen::MatrixXd& error);

}  // namespace elastogear::life
