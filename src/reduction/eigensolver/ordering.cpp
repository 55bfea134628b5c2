#include "reduction/eigensolver/ordering.h"

#include <metis.h>

#include <algorithm>

#include "elastogear/base/error.h"

namespace elastogear::reduction {
namespace {

static_assert(sizeof(idx_t) == sizeof(int), "METIS must be built with 32-bit indices");
constexpr idx_t kSeed = 1;

struct Graph {
  std::vector<int> degree, neighbour;  // rows one after the other, without the diagonal
};

Graph local_graph(Mat A) {
  PetscInt begin = 0, end = 0;
  check(MatGetOwnershipRange(A, &begin, &end));
  Graph graph;
  for (PetscInt i = begin; i < end; ++i) {
    PetscInt n = 0;
    const PetscInt* column = nullptr;
    check(MatGetRow(A, i, &n, &column, nullptr));
    const std::size_t before = graph.neighbour.size();
    for (PetscInt k = 0; k < n; ++k)
      if (column[k] != i) graph.neighbour.push_back(column[k]);
    graph.degree.push_back(static_cast<int>(graph.neighbour.size() - before));
    check(MatRestoreRow(A, i, &n, &column, nullptr));
  }
  return graph;
}

// The parts of all ranks in the order of ranks, on rank 0.
std::vector<int> concatenate(MPI_Comm comm, const std::vector<int>& part) {
  int rank = 0, size = 1, length = static_cast<int>(part.size());
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  std::vector<int> lengths(size), offset(size + 1, 0);
  MPI_Gather(&length, 1, MPI_INT, lengths.data(), 1, MPI_INT, 0, comm);
  for (int r = 0; r < size; ++r) offset[r + 1] = offset[r] + lengths[r];
  std::vector<int> whole(rank == 0 ? offset[size] : 0);
  MPI_Gatherv(part.data(), length, MPI_INT, whole.data(), lengths.data(), offset.data(), MPI_INT, 0, comm);
  return whole;
}

std::vector<int> order(const std::vector<int>& degree, std::vector<int>& neighbour) {
  idx_t n = static_cast<idx_t>(degree.size());
  std::vector<idx_t> offset(degree.size() + 1, 0), row_at(degree.size()), position(degree.size());
  for (std::size_t i = 0; i < degree.size(); ++i) offset[i + 1] = offset[i] + degree[i];
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = kSeed;
  const int status =
      METIS_NodeND(&n, offset.data(), neighbour.data(), nullptr, options, row_at.data(), position.data());
  require(status == METIS_OK, "METIS could not order ", n, " rows (status ", status, ")");
  return position;
}

// Rows of a matrix of n rows that are not among these, ascending.
std::vector<PetscInt> others(PetscInt n, const std::vector<int>& rows) {
  std::vector<PetscInt> rest;
  for (PetscInt i = 0; i < n; ++i)
    if (!std::binary_search(rows.begin(), rows.end(), i)) rest.push_back(i);
  return rest;
}

}  // namespace

std::vector<int> nested_dissection(Mat A, const std::vector<int>& last) {
  PetscInt n = 0;
  check(MatGetSize(A, &n, nullptr));
  const std::vector<PetscInt> first = others(n, last);
  const auto n_first = static_cast<PetscInt>(first.size());
  UniqueIS rows;
  UniqueMat block;
  check(ISCreateGeneral(PETSC_COMM_SELF, n_first, first.data(), PETSC_USE_POINTER, rows.out()));
  check(MatCreateSubMatrix(A, rows, rows, MAT_INITIAL_MATRIX, block.out()));
  const std::vector<int> order_of_first = nested_dissection(block);
  std::vector<int> position(static_cast<std::size_t>(n));
  for (std::size_t i = 0; i < first.size(); ++i) position[first[i]] = order_of_first[i];
  for (std::size_t i = 0; i < last.size(); ++i) position[last[i]] = n_first + static_cast<int>(i);
  return position;
}

std::vector<int> nested_dissection(Mat A) {
  const MPI_Comm comm = comm_of(A);
  const Graph local = local_graph(A);
  const std::vector<int> degree = concatenate(comm, local.degree);
  std::vector<int> neighbour = concatenate(comm, local.neighbour);
  return degree.empty() ? std::vector<int>{} : order(degree, neighbour);
}

}  // namespace elastogear::reduction
