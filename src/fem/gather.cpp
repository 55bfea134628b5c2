#include "elastogear/fem/gather.h"

#include <algorithm>
#include <numeric>

namespace elastogear::fem {
namespace {

// Per scalar row its number among the displacements in ascending order.
std::vector<int> ranks_of(const std::vector<int>& dof) {
  std::vector<int> row(dof.size()), number(dof.size());
  std::iota(row.begin(), row.end(), 0);
  std::sort(row.begin(), row.end(), [&](int i, int j) { return dof[i] < dof[j]; });
  for (std::size_t i = 0; i < row.size(); ++i) number[row[i]] = static_cast<int>(i);
  return number;
}

}  // namespace

std::vector<int> row_dofs(const RowNumbering& rows) {
  std::vector<int> dof;
  for (int node : rows.node) dof.insert(dof.end(), {3 * node, 3 * node + 1, 3 * node + 2});
  return dof;
}

VectorGather::VectorGather(Vec layout, const RowNumbering& rows)
    : VectorGather(layout, row_dofs(rows), 3 * static_cast<int>(rows.row.size())) {}

VectorGather::VectorGather(Vec layout, std::vector<int> dof, int n_dofs)
    : dof_(std::move(dof)), n_dofs_(n_dofs) {
  check(VecScatterCreateToZero(layout, scatter_.out(), on_root_.out()));
}

Eigen::VectorXd VectorGather::operator()(Vec v) const {
  check(VecScatterBegin(scatter_, v, on_root_, INSERT_VALUES, SCATTER_FORWARD));
  check(VecScatterEnd(scatter_, v, on_root_, INSERT_VALUES, SCATTER_FORWARD));
  PetscInt n = 0;
  const PetscScalar* values = nullptr;
  check(VecGetLocalSize(on_root_, &n));
  check(VecGetArrayRead(on_root_, &values));
  Eigen::VectorXd u = Eigen::VectorXd::Zero(n > 0 ? n_dofs_ : 0);
  for (PetscInt i = 0; i < n; ++i) u(dof_[i]) = values[i];
  check(VecRestoreArrayRead(on_root_, &values));
  return u;
}

void VectorGather::scatter(const Eigen::VectorXd& u, Vec v) const {
  PetscInt n = 0;
  PetscScalar* values = nullptr;
  check(VecGetLocalSize(on_root_, &n));
  check(VecGetArrayWrite(on_root_, &values));
  for (PetscInt i = 0; i < n; ++i) values[i] = u(dof_[i]);
  check(VecRestoreArrayWrite(on_root_, &values));
  check(VecScatterBegin(scatter_, on_root_, v, INSERT_VALUES, SCATTER_REVERSE));
  check(VecScatterEnd(scatter_, on_root_, v, INSERT_VALUES, SCATTER_REVERSE));
}

UniqueMat on_root(Mat A) {
  const MPI_Comm comm = comm_of(A);
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

Eigen::SparseMatrix<double> gather_matrix(Mat A, const RowNumbering& rows) {
  return gather_matrix(A, row_dofs(rows));
}

Eigen::SparseMatrix<double> gather_matrix(Mat A, const std::vector<int>& dof) {
  const UniqueMat root = on_root(A);
  const std::vector<int> number = ranks_of(dof);
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
