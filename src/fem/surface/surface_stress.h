#pragma once
// Stress on a free surface from the displacements of the surface alone (docs/theory, section 1.5).

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "fem/surface/free_surface.h"

namespace elastogear::fem {

/// Rows of the stress operator at one node.
struct SurfaceRows {
  std::vector<int> node;                       ///< n nodes of the surface, whose displacements count
  Eigen::Matrix<double, 6, Eigen::Dynamic> S;  ///< 6 x 3 n, Pa/m, order xx yy zz xy yz xz
  /// 6 x 6, of any stress what the strains within the surface make of it without traction: Eq. (1.16a).
  Eigen::Matrix<double, 6, 6> within = Eigen::Matrix<double, 6, 6>::Zero();
};

/// Stress at a node of a free surface; nothing where averages are to be taken: where FreeSurface finds no
/// sheets, and where the nodes around lie on one line. material: of the region at the node.
std::optional<SurfaceRows> surface_stress(const FreeSurface& surface, const Eigen::Matrix3Xd& X,
                                          const model::Material& material, int node);

}  // namespace elastogear::fem
