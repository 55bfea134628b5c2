#pragma once
// The stiffness of what relaxes in a body with viscoelastic materials (docs/theory, section 1.4).

#include <vector>

#include "elastogear/mesh/mesh.h"
#include "elastogear/model/elastic_body.h"
#include "elastogear/model/material.h"

namespace elastogear::fem {

/// A part of the moduli of one region that relaxes by one function of time: a term of Eq. (1.12).
struct RelaxingModuli {
  int region = 0;  ///< index into the regions
  model::ModulusPart part = model::ModulusPart::both;
  std::vector<double> g;    ///< -, relative moduli
  std::vector<double> tau;  ///< s, at the temperature of the region
};

/// All of them, one region after the other: one entry where Poisson's ratio is constant, else two, or one
/// where only one of the moduli relaxes.
std::vector<RelaxingModuli> relaxing_moduli(const std::vector<model::MaterialRegion>& regions);

/// Instantaneous stiffness of the region's cells by this part of its moduli, over all displacements (3
/// n_nodes square), N/m. region: of each cell.
model::SparseRows relaxing_stiffness(const mesh::Mesh& mesh,
                                     const std::vector<model::MaterialRegion>& regions,
                                     const std::vector<int>& region, const RelaxingModuli& moduli,
                                     model::Element element);

}  // namespace elastogear::fem
