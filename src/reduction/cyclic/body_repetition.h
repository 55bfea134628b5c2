#pragma once
// Finds whether a whole body, its mesh, its restraint and its materials, repeats around an axis:
// docs/theory, section 2.6.

#include <vector>

#include "elastogear/mesh/repetition.h"
#include "elastogear/model/material.h"

namespace elastogear::reduction {

/// The repetition of the mesh and its labels where the directions of all materials turn with it, else the
/// reason why there is none.
mesh::RepetitionSearch find_body_repetition(const mesh::Mesh& mesh,
                                            const std::vector<model::MaterialRegion>& regions,
                                            const mesh::Labels& labels);

}  // namespace elastogear::reduction
