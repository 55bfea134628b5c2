#pragma once
// Meshes of 20-node hexahedra, made of meshes of 8-node hexahedra.

#include <Eigen/Core>
#include <functional>

#include "elastogear/mesh/mesh.h"

namespace elastogear::gear {

/// Position (m) of the midside node of the edge between two nodes of the linear mesh.
using Midside = std::function<Eigen::Vector3d(int a, int b)>;

/// The linear mesh with a node on each edge, which belongs to the node sets that hold both of the edge's
/// ends. Faces are cut as mesh::side_faces does it. The linear mesh is numbered by sectors, n nodes in each;
/// so is the result, each sector's midside nodes behind its n nodes. Edges between two sectors belong to the
/// former.
mesh::Mesh second_order(const mesh::Mesh& linear, const Midside& midside, int sectors = 1);

/// Throws Error for orders other than 1 and 2. body: the gear's name.
void check_order(const std::string& body, int order);

}  // namespace elastogear::gear
