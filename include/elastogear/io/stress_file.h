#pragma once
// The stress file (HDF5, docs/file_format.md): written by recover, read by compare, info and scripts.

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "elastogear/model/run_input.h"

namespace elastogear::io {

/// Histories at the nodes of one evaluation set, one column per time; body frame.
struct StressSet {
  std::string body, set;
  std::vector<int> node;      ///< n, mesh numbers
  Eigen::MatrixXd stress;     ///< 6 n x n_t, Pa, rows xx yy zz xy yz xz of node 0, then node 1, ...
  Eigen::MatrixXd von_mises;  ///< n x n_t, Pa
  Eigen::MatrixXd rankine;    ///< n x n_t, Pa, largest principal stress
  Eigen::Matrix3Xd X = {};    ///< 3 x n, m, undeformed; empty in files written before it was kept
  /// n x n_t, Pa, estimated error of von_mises against the unreduced body on the same mesh; or empty
  Eigen::MatrixXd error = {};
  Eigen::VectorXd peak_error = {};  ///< n_t, Pa, of the set's largest von Mises stress; or empty
  /// n x n_t, Pa, estimated error of von_mises by the mesh, against the continuum; or empty
  Eigen::MatrixXd mesh_error = {};
  /// n x n_t, Pa, estimated error of von_mises by the place of contact forces within faces; or empty
  Eigen::MatrixXd contact_error = {};
  /// n x n_t, Pa, estimated error of von_mises by the steps in time; or empty
  Eigen::MatrixXd time_error = {};
};

struct StressFile {
  Eigen::VectorXd time;  ///< n_t, s
  std::vector<StressSet> sets;
  std::map<std::string, std::string> provenance;
  std::optional<model::RunInput> input = {};  ///< of the run that they are of; nothing: not known
};

/// Error when shapes disagree, node numbers are negative or stresses are not finite; the file appears only
/// when complete.
void write_stress(const std::string& path, const StressFile& history);
/// Error as of write_stress. Which node numbers the body's mesh has the file does not say.
StressFile read_stress(const std::string& path);

}  // namespace elastogear::io
