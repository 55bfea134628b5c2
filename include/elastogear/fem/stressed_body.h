#pragma once
// A finite-element body with all that the recovery of its nodal stresses needs but the displacements.

#include <vector>

#include "elastogear/mesh/hold.h"
#include "elastogear/mesh/mesh.h"
#include "elastogear/model/material.h"
#include "elastogear/model/stress_recovery.h"

namespace elastogear::fem {

/// A body as its stresses are recovered.
struct StressedBody {
  const mesh::Mesh& mesh;
  const std::vector<model::MaterialRegion>& regions;
  model::Element element;
  model::StressRecovery recovery = {};
  std::vector<mesh::Directions> held = {};  ///< of each node; empty: no node is held
};

}  // namespace elastogear::fem
