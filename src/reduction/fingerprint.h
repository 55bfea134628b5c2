#pragma once
// Fingerprints of distributed matrices and of materials.

#include "elastogear/base/fingerprint.h"
#include "elastogear/base/petsc.h"
#include "elastogear/model/material.h"

namespace elastogear::reduction {

/// Fingerprint of the entries, their places and their distribution over the ranks; equal on all ranks.
/// Collective.
std::uint64_t fingerprint(Mat A);

/// Elastic moduli, density and their directions.
void add(Fingerprint& f, const model::Material& material);

}  // namespace elastogear::reduction
