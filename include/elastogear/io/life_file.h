#pragma once
// The life file (HDF5, docs/file_format.md): written by life, read by scripts.

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

namespace elastogear::io {

/// Cycles that one node bears in one duty cycle, n each.
struct CycleTable {
  std::vector<int> block;         ///< 0-based, of the duty cycle
  Eigen::VectorXd range, mean;    ///< Pa
  Eigen::VectorXd amplitude;      ///< Pa, fully reversed, doing the same damage
  Eigen::VectorXd count, damage;  ///< in one duty cycle
};

/// Damage at the nodes of an evaluation set over one duty cycle.
struct LifeSet {
  std::string body, set;
  std::vector<int> node;         ///< n, mesh numbers
  std::vector<int> tooth;        ///< n, from 1, nearest to the node
  Eigen::Matrix3Xd X;            ///< 3 x n, m, undeformed, body frame
  Eigen::VectorXd damage;        ///< n
  Eigen::MatrixXd block_damage;  ///< n x n_blocks
  Eigen::VectorXd amplitude;     ///< n, Pa, largest fully reversed amplitude that does the same damage
  int critical = 0;              ///< local number of the node of the largest damage
  Eigen::VectorXd roll;          ///< n_t, pitches, of the history
  Eigen::MatrixXd history;       ///< n_t x n_blocks, Pa, signed principal stress of the critical node
  CycleTable cycles;             ///< of the critical node
  /// n, by stresses that are larger by their estimated error; infinite where they break the part; or empty
  Eigen::VectorXd damage_with_error = {};
};

struct LifeFile {
  Eigen::VectorXd torque, revolutions, time;  ///< n_blocks: N m, 1, s (0: not known), of the first gear
  std::vector<LifeSet> sets;
  std::map<std::string, std::string> provenance;
};

/// Error when shapes disagree or numbers are not finite; the file appears only when complete.
void write_life(const std::string& path, const LifeFile& life);

}  // namespace elastogear::io
