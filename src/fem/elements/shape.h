#pragma once
// Shape functions of all cell types (docs/theory, section 1.1).
//
// Reference cells: hexahedra [-1, 1]^3; tetrahedra xi, eta, zeta >= 0 with sum <= 1; wedges triangle times
// [-1, 1]; the pyramid [-1, 1]^3 with the face zeta = 1 collapsed into the apex.

#include <Eigen/Core>

#include "elastogear/mesh/mesh.h"

namespace elastogear::fem {

struct ShapeValues {
  Eigen::VectorXd N;   ///< n_nodes
  Eigen::MatrixXd dN;  ///< n_nodes x 3, derivatives by xi, eta, zeta
};

ShapeValues shape_values(mesh::CellType type, const Eigen::Vector3d& xi);

/// Reference coordinates of the nodes, 3 x n_nodes.
Eigen::Matrix3Xd reference_nodes(mesh::CellType type);

}  // namespace elastogear::fem
