#include "reduction/fingerprint.h"

#include <vector>

namespace elastogear::reduction {

std::uint64_t fingerprint(Mat A) {
  const MPI_Comm comm = comm_of(A);
  Fingerprint own, all;
  PetscInt begin = 0, end = 0;
  check(MatGetOwnershipRange(A, &begin, &end));
  for (PetscInt i = begin; i < end; ++i) {
    PetscInt n = 0;
    const PetscInt* column = nullptr;
    const PetscScalar* value = nullptr;
    check(MatGetRow(A, i, &n, &column, &value));
    for (PetscInt k = 0; k < n; ++k) {
      own.add(static_cast<std::uint64_t>(column[k]));
      own.add(value[k]);
    }
    check(MatRestoreRow(A, i, &n, &column, &value));
  }
  own.add(static_cast<std::uint64_t>(end));
  int size = 1;
  MPI_Comm_size(comm, &size);
  const std::uint64_t mine = own.value();
  std::vector<std::uint64_t> of_rank(size);
  MPI_Allgather(&mine, 1, MPI_UINT64_T, of_rank.data(), 1, MPI_UINT64_T, comm);
  for (std::uint64_t word : of_rank) all.add(word);
  return all.value();
}

void add(Fingerprint& f, const model::Material& material) {
  for (double x : {material.E, material.nu, material.rho}) f.add(x);
  if (!material.orthotropic) return;
  const auto& [E, nu, G, o] = *material.orthotropic;
  f.add(static_cast<double>(o.system));
  for (const auto& v : {E, nu, G, o.axis_1, o.axis_2, o.origin, o.axis, o.rotation}) f.add_all(v);
}

}  // namespace elastogear::reduction
