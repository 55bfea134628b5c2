#pragma once
// Plane sections of a mesh, for drawings.

#include <vector>

#include "elastogear/mesh/mesh.h"

namespace elastogear::app {

/// A plane in the frame of the mesh: through `point`, seen against its normal e_1 x e_2.
struct Plane {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d e_1 = Eigen::Vector3d::UnitX(), e_2 = Eigen::Vector3d::UnitY();
};

/// Closed outlines of the section, m, in the coordinates along e_1 and e_2 from the plane's point. The plane
/// is moved by a millionth of the mesh's size, so that no node is on it.
std::vector<std::vector<Eigen::Vector2d>> section(const mesh::Mesh& mesh, const Plane& plane);

}  // namespace elastogear::app
