#pragma once
// Fields on a body's mesh for ParaView: VTU (one time) and PVD (a series of VTU files).

#include <Eigen/Core>
#include <string>
#include <vector>

#include "elastogear/mesh/mesh.h"

namespace elastogear::io {

/// A field at the nodes. 3 components make a vector; 6 are named XX YY ZZ XY YZ XZ.
struct NodeField {
  std::string name;        ///< with its unit, as ParaView shows it: "displacement [m]"
  Eigen::MatrixXd values;  ///< n_components x n_nodes
};

/// Unstructured grid with point data, appended raw binary, double precision. Error when a field does not fit
/// the mesh or is not finite.
void write_vtu(const std::string& path, const mesh::Mesh& mesh, const std::vector<NodeField>& fields);

struct TimeStep {
  double time = 0;   ///< s
  std::string file;  ///< of that time, relative to the PVD file
};

void write_pvd(const std::string& path, const std::vector<TimeStep>& steps);

}  // namespace elastogear::io
