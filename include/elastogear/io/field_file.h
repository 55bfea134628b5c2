#pragma once
// Fields on a body's mesh for ParaView: VTU (one body, one time) and PVD (bodies and times of VTU files).

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

/// One file of a series: a body at one time.
struct SeriesFile {
  double time = 0;   ///< s
  std::string file;  ///< relative to the PVD file
  int part = 0;      ///< number of the body among those of the series
  std::string name;  ///< of the body; empty: none
};

/// Collection of field files of several times and bodies.
void write_pvd(const std::string& path, const std::vector<SeriesFile>& files);

}  // namespace elastogear::io
