#include "elastogear/fem/elimination.h"

namespace elastogear::fem {
namespace {

UniqueMat part(Mat A, IS rows) {
  UniqueMat result;
  check(MatCreateSubMatrix(A, rows, rows, MAT_INITIAL_MATRIX, result.out()));
  check(MatSetOption(result, MAT_SPD, PETSC_TRUE));
  return result;
}

}  // namespace

void eliminate(const std::vector<mesh::Directions>& held, Matrices& matrices, std::vector<int>& dof) {
  const MPI_Comm comm = comm_of(matrices.K);
  PetscInt n = 0, begin = 0, end = 0;
  check(MatGetSize(matrices.K, &n, nullptr));
  check(MatGetOwnershipRange(matrices.K, &begin, &end));
  std::vector<char> keep(static_cast<std::size_t>(n), 0);
  std::vector<int> kept;
  for (std::size_t row = 0; row < dof.size(); ++row) {
    keep[row] = !mesh::holds(held[dof[row] / 3], dof[row] % 3);
    if (keep[row]) kept.push_back(dof[row]);
  }
  MPI_Bcast(keep.data(), static_cast<int>(n), MPI_CHAR, 0, comm);
  std::vector<PetscInt> own;
  for (PetscInt row = begin; row < end; ++row)
    if (keep[row]) own.push_back(row);
  UniqueIS rows;
  check(ISCreateGeneral(comm, static_cast<PetscInt>(own.size()), own.data(), PETSC_COPY_VALUES, rows.out()));
  matrices = {part(matrices.K, rows), part(matrices.M, rows)};
  dof = std::move(kept);
}

}  // namespace elastogear::fem
