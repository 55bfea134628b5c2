#pragma once
// Shape functions of the sides of cells.

#include <Eigen/Core>

namespace elastogear::model {

/// At most 8 values, one for each node of a side.
using SideShape = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 8, 1>;

/// Of a side of 3, 4, 6 or 8 nodes, corners first, then midside nodes from that between corners 0 and 1 on:
/// of triangles at xi, eta >= 0 with a sum of at most 1, of quadrilaterals in [-1, 1]^2.
SideShape side_shape(int n, double xi, double eta);

}  // namespace elastogear::model
