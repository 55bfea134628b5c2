#pragma once
// Effective masses of a cyclically symmetric body, from its sector (docs/theory, section 2.3).

#include "elastogear/fem/balance.h"
#include "elastogear/mesh/repetition.h"
#include "reduction/modes/effective_mass.h"

namespace elastogear::reduction {

/// mobile_masses of the body, whose rigid motions are all in harmonics 0 and 1. body: regions and formulation
/// on all ranks, the rest, moments and c on rank 0. Collective.
SixDirections cyclic_mobile_masses(MPI_Comm comm, const fem::MeshedBody& body,
                                   const mesh::Repetition& repetition, const fem::MassMoments& moments,
                                   const Eigen::Vector3d& c);

}  // namespace elastogear::reduction
