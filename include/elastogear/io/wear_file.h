#pragma once
// The wear file (HDF5, docs/file_format.md): written by wear, read by scripts.

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

namespace elastogear::io {

/// Worn flanks of one gear, all teeth alike.
struct WornGear {
  std::string body;
  Eigen::VectorXd diameter, roll;  ///< n_u, m, of the middles of cells along the profile; lengths of roll
  Eigen::VectorXd z;               ///< n_v, m, of the middles of cells across the face
  Eigen::MatrixXd left, right;     ///< n_u x n_v, m, depth at the end
  Eigen::VectorXd largest, mass;   ///< n_steps, m, kg, over the revolutions
  /// n_steps, m, kg, estimated errors by the mesh; empty: not estimated.
  Eigen::VectorXd largest_mesh_error = {}, mass_mesh_error = {};
};

struct WearFile {
  Eigen::VectorXd revolutions;  ///< n_steps, of the first gear
  std::vector<WornGear> gears;
  std::map<std::string, std::string> provenance;
};

/// Error when shapes disagree or numbers are not finite; the file appears only when complete.
void write_wear(const std::string& path, const WearFile& wear);

}  // namespace elastogear::io
