#include "fingerprint.h"

#include <bit>
#include <cstdio>
#include <vector>

namespace elastogear::reduction {

// The mixing of splitmix64 (Steele, Lea & Flood, OOPSLA 2014).
void Fingerprint::add(std::uint64_t word) {
  std::uint64_t z = (state_ ^ word) + 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  state_ = z ^ (z >> 31);
}

void Fingerprint::add(double x) { add(std::bit_cast<std::uint64_t>(x)); }

void Fingerprint::add(const std::string& text) {
  add(static_cast<std::uint64_t>(text.size()));
  for (char c : text) add(static_cast<std::uint64_t>(static_cast<unsigned char>(c)));
}

std::string Fingerprint::text() const {
  char digits[17];
  std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(state_));
  return digits;
}

std::uint64_t fingerprint(Mat A) {
  const MPI_Comm comm = PetscObjectComm(reinterpret_cast<PetscObject>(A));
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

}  // namespace elastogear::reduction
