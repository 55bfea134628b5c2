#include "fem/spd_matrix.h"

namespace elastogear::fem {

UniqueMat create_spd_matrix(MPI_Comm comm, int block_size, const BlockCounts& counts) {
  UniqueMat A;
  const PetscInt n = block_size * static_cast<PetscInt>(counts.diagonal.size());
  check(MatCreate(comm, A.out()));
  check(MatSetSizes(A, n, n, PETSC_DETERMINE, PETSC_DETERMINE));
  check(MatSetType(A, MATAIJ));
  check(
      MatXAIJSetPreallocation(A, block_size, counts.diagonal.data(), counts.other.data(), nullptr, nullptr));
  check(MatSetOption(A, MAT_NO_OFF_PROC_ENTRIES, PETSC_TRUE));
  check(MatSetOption(A, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_TRUE));
  check(MatSetOption(A, MAT_SPD, PETSC_TRUE));
  return A;
}

void finish_assembly(Mat A) {
  check(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
}

}  // namespace elastogear::fem
