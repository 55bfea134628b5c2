#pragma once
// The body of a file as its stresses are recovered.

#include "elastogear/fem/restraint.h"
#include "elastogear/fem/stressed_body.h"
#include "elastogear/io/body_file.h"

namespace elastogear::reduction {

/// Reduced and unreduced bodies take their stresses from this one. The source outlives it.
inline fem::StressedBody stressed_body(const io::BodySource& source) {
  return {source.mesh, source.regions, source.element, source.recovery,
          fem::held_directions(source.free_dof, source.mesh.n_nodes())};
}

}  // namespace elastogear::reduction
