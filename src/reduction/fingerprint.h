#pragma once
// Fingerprints of distributed matrices.

#include "elastogear/base/fingerprint.h"
#include "elastogear/base/petsc.h"

namespace elastogear::reduction {

/// Fingerprint of the entries, their places and their distribution over the ranks; equal on all ranks.
/// Collective.
std::uint64_t fingerprint(Mat A);

}  // namespace elastogear::reduction
