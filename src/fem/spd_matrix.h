#pragma once
// Distributed symmetric positive definite matrices that are filled cell by cell.

#include <vector>

#include "elastogear/base/petsc.h"

namespace elastogear::fem {

/// Number of blocks in each owned block row: in columns of this rank, and in columns of others.
struct BlockCounts {
  std::vector<PetscInt> diagonal, other;
};

/// An empty MATAIJ with room for so many blocks of block_size x block_size. Each rank adds to its own rows
/// only; an entry without room is an error. Collective.
UniqueMat create_spd_matrix(MPI_Comm comm, int block_size, const BlockCounts& counts);

void finish_assembly(Mat A);

}  // namespace elastogear::fem
