#pragma once
// The faces of a flank in the chart of its exact surface.

#include <vector>

#include "contact/stations/smooth_load.h"
#include "elastogear/contact/exact_flanks.h"
#include "elastogear/model/elastic_body.h"

namespace elastogear::contact {

/// One flank of a mesh.
struct FlankMesh {
  FlankName name;
  FlankGrid grid = {};                      ///< its nodes are numbers in `node`
  std::vector<int> node = {};               ///< of the surface, row by row; with patches in any order
  std::vector<int> face = {};               ///< of the surface
  std::vector<Eigen::Vector2d> place = {};  ///< m, (v, z) of each node
  int like = 0;                             ///< the first flank with the same grid, nodes in the same order
  std::vector<Eigen::Matrix<double, 2, 4>> at = {};  ///< m, (v, z) of the corners of each face
};

/// All flanks of a surface that its exact flanks name.
std::vector<FlankMesh> flank_meshes(const model::Surface& surface, const ExactFlanks& flanks);

/// Where a place of the chart lies on the faces of a flank.
struct FaceOfFlank {
  int face;        ///< of the surface
  double xi, eta;  ///< on it, Eq. (6.1)
};
/// The face nearest to (v, z).
FaceOfFlank face_at(const FlankMesh& flank, double v, double z);

}  // namespace elastogear::contact
