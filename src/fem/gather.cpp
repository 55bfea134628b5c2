#include "elastogear/fem/gather.h"

#include <vector>

namespace elastogear::fem {
namespace {

// Per scalar row of the distributed matrix its number among the free displacements in the mesh's order.
std::vector<int> free_numbers(const RowNumbering& rows) {
  std::vector<int> number(3 * rows.node.size());
  int next = 0;
  for (int row : rows.row)
    for (int d = 0; row >= 0 && d < 3; ++d) number[3 * static_cast<std::size_t>(row) + d] = next++;
  return number;
}

// The same matrix with every row and column on rank 0.
UniqueMat on_root(Mat A) {
  const MPI_Comm comm = PetscObjectComm(reinterpret_cast<PetscObject>(A));
  PetscMPIInt rank = 0;
  PetscInt n = 0;
  UniqueMat root;
  UniqueIS all;
  MPI_Comm_rank(comm, &rank);
  check(MatGetSize(A, &n, nullptr));
  check(ISCreateStride(comm, rank == 0 ? n : 0, 0, 1, all.out()));
  check(MatCreateSubMatrix(A, all, all, MAT_INITIAL_MATRIX, root.out()));
  return root;
}

}  // namespace

VectorGather::VectorGather(Vec layout, const RowNumbering& rows) : rows_(&rows) {
  check(VecScatterCreateToZero(layout, scatter_.out(), on_root_.out()));
}

Eigen::VectorXd VectorGather::operator()(Vec v) const {
  check(VecScatterBegin(scatter_, v, on_root_, INSERT_VALUES, SCATTER_FORWARD));
  check(VecScatterEnd(scatter_, v, on_root_, INSERT_VALUES, SCATTER_FORWARD));
  PetscInt n = 0;
  const PetscScalar* values = nullptr;
  check(VecGetLocalSize(on_root_, &n));
  check(VecGetArrayRead(on_root_, &values));
  Eigen::VectorXd u = Eigen::VectorXd::Zero(n > 0 ? 3 * static_cast<Eigen::Index>(rows_->row.size()) : 0);
  for (PetscInt i = 0; i < n; ++i) u(3 * rows_->node[static_cast<std::size_t>(i / 3)] + i % 3) = values[i];
  check(VecRestoreArrayRead(on_root_, &values));
  return u;
}

Eigen::SparseMatrix<double> gather_matrix(Mat A, const RowNumbering& rows) {
  const UniqueMat root = on_root(A);
  const std::vector<int> number = free_numbers(rows);
  std::vector<Eigen::Triplet<double>> entries;
  PetscInt begin = 0, end = 0;
  check(MatGetOwnershipRange(root, &begin, &end));
  for (PetscInt row = begin; row < end; ++row) {
    PetscInt n = 0;
    const PetscInt* columns = nullptr;
    const PetscScalar* values = nullptr;
    check(MatGetRow(root, row, &n, &columns, &values));
    for (PetscInt k = 0; k < n; ++k) entries.emplace_back(number[row], number[columns[k]], values[k]);
    check(MatRestoreRow(root, row, &n, &columns, &values));
  }
  Eigen::SparseMatrix<double> gathered(end, end);
  gathered.setFromTriplets(entries.begin(), entries.end());
  return gathered;
}

}  // namespace elastogear::fem
