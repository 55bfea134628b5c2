#pragma once
// *TRANSFORM of an Abaqus input file: axes of nodes in which *BOUNDARY holds directions.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "elastogear/mesh/hold.h"
#include "mesh/inp/lines/inp_lines.h"
#include "mesh/inp/lines/inp_sets.h"

namespace elastogear::mesh {

struct Transform {
  std::string members;  // node set
  bool cylindrical = false;
  Eigen::Vector3d a = {},
                  b = {};  // points on the first axis and in the plane of two, or on the cylinder's axis
  int line = 0;
};

Transform read_transform(InpLines& in, const Keyword& key);

/// Turns directions that are held in local axes into those of the mesh, which they must be: a body is held
/// along the axes of its mesh alone. Error naming the node where they are not.
void to_mesh_axes(const InpLines& in, const std::vector<Transform>& transforms, const InpSets& node_sets,
                  const std::vector<Tag>& node_number, const Mesh& mesh, std::vector<Directions>& held);

}  // namespace elastogear::mesh
