#pragma once
// Stiffness and mass of one harmonic of a cyclically symmetric body, from one sector's elements.

#include <utility>

#include "elastogear/fem/assembly.h"
#include "elastogear/fem/sector.h"

namespace elastogear::fem {

/// First and end of the free orbits whose rows this rank of comm owns: a contiguous, equal share.
std::pair<int, int> own_orbits(MPI_Comm comm, const Sector& sector);

/// K_k and M_k over the harmonic's coordinates, symmetric, MATAIJ, of one sparsity. Every eigenvalue of a
/// harmonic that is not real is double: z and i z. Collective; needs no communication.
/// docs/theory, Eq. (2.11).
Matrices assemble(MPI_Comm comm, const Sector& sector, const Harmonic& harmonic,
                  const std::vector<model::MaterialRegion>& regions, const model::Formulation& formulation);
/// M_k alone.
UniqueMat assemble_mass(MPI_Comm comm, const Sector& sector, const Harmonic& harmonic,
                        const std::vector<model::MaterialRegion>& regions,
                        const model::Formulation& formulation);

}  // namespace elastogear::fem
