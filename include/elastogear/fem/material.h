#pragma once
// Materials of a mesh: which cell has which, and isotropic elasticity.

#include <Eigen/Core>
#include <vector>

#include "elastogear/mesh/mesh.h"
#include "elastogear/model/material.h"

namespace elastogear::fem {

/// Lame constants, Pa: sigma = lambda tr(eps) I + 2 mu eps.
struct Lame {
  double lambda = 0, mu = 0;
};
Lame lame(const model::Material& material);

/// Throws Error (naming the region) unless E > 0, -1 < nu < 0.5 and rho > 0 for every region.
void validate(const std::vector<model::MaterialRegion>& regions);

/// Index into `regions` of every cell. The region with the empty name takes the cells that no other names.
/// Throws Error for an unknown set, a cell in two regions, a cell in none, two regions of one name.
std::vector<int> cell_regions(const mesh::Mesh& mesh, const std::vector<model::MaterialRegion>& regions);

}  // namespace elastogear::fem
