#include "reduction/static_response/inertia_relief.h"

#include <Eigen/Cholesky>

#include "elastogear/base/error.h"
#include "reduction/eigensolver/block_product.h"
#include "reduction/eigensolver/krylov_basis.h"

namespace elastogear::reduction {
namespace {

using Eigen::MatrixXd;

constexpr double kDependent = 1e-12;  // of fields: smallest over largest pivot of their Gram matrix

MatrixXd own_rows(BV R) {
  PetscInt first = 0, end = 0, n_own = 0;
  check(BVGetActiveColumns(R, &first, &end));
  check(BVGetSizes(R, &n_own, nullptr, nullptr));
  MatrixXd rows(n_own, end - first);
  for (PetscInt j = first; j < end; ++j) {
    Vec column = nullptr;
    const PetscScalar* values = nullptr;
    check(BVGetColumn(R, j, &column));
    check(VecGetArrayRead(column, &values));
    rows.col(j - first) = Eigen::Map<const Eigen::VectorXd>(values, n_own);
    check(VecRestoreArrayRead(column, &values));
    check(BVRestoreColumn(R, j, &column));
  }
  return rows;
}

// The rank with the longest row of `rest`, and its number there.
std::pair<int, Eigen::Index> longest_row(MPI_Comm comm, const MatrixXd& rest) {
  struct {
    double length;
    int rank;
  } own{-1, 0}, all{};
  Eigen::Index row = 0;
  MPI_Comm_rank(comm, &own.rank);
  if (rest.rows() > 0) own.length = rest.rowwise().squaredNorm().maxCoeff(&row);
  MPI_Allreduce(&own, &all, 1, MPI_DOUBLE_INT, MPI_MAXLOC, comm);
  return {all.rank, own.rank == all.rank ? row : -1};
}

// Own rows in which the rigid motions differ most: by pivoted Gram-Schmidt, one for each motion in all.
std::vector<Eigen::Index> holding_rows(MPI_Comm comm, MatrixXd rest) {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < rest.cols(); ++i) {
    const auto [rank, row] = longest_row(comm, rest);
    Eigen::RowVectorXd longest(rest.cols());
    if (row >= 0) {
      longest = rest.row(row);
      rows.push_back(row);
    }
    MPI_Bcast(longest.data(), static_cast<int>(longest.size()), MPI_DOUBLE, rank, comm);
    rest -= (rest * longest.transpose() / longest.squaredNorm() * longest).eval();
  }
  return rows;
}

}  // namespace

InertiaRelief::InertiaRelief(Mat M, MatrixXd R) : comm_(comm_of(M)), R_(std::move(R)) {
  const BlockProduct M_times(M);
  const Eigen::LDLT<MatrixXd> pivots(inner(comm_, R_, M_times(R_)));
  const auto d = pivots.vectorD();
  require(d.minCoeff() > kDependent * d.maxCoeff(), "the rigid motions of the free body are not independent");
  for (int pass = 0; pass < 2; ++pass) {
    const Eigen::LLT<MatrixXd> gram(inner(comm_, R_, M_times(R_)));
    R_ = gram.matrixL().solve(R_.transpose()).transpose().eval();
  }
  M_R_ = M_times(R_);
}

InertiaRelief::InertiaRelief(Mat M, const RigidModes& rigid) : InertiaRelief(M, own_rows(rigid.R)) {}

void InertiaRelief::balance(Eigen::Ref<MatrixXd> F) const { F -= M_R_ * inner(comm_, R_, F); }

void InertiaRelief::release(Eigen::Ref<MatrixXd> U) const { U -= R_ * inner(comm_, M_R_, U); }

UniqueMat InertiaRelief::ground(Mat K) const {
  UniqueMat grounded;
  UniqueVec diagonal;
  const PetscScalar* values = nullptr;
  PetscInt first = 0;
  check(MatDuplicate(K, MAT_COPY_VALUES, grounded.out()));
  check(MatCreateVecs(K, nullptr, diagonal.out()));
  check(MatGetDiagonal(K, diagonal));
  check(MatGetOwnershipRange(K, &first, nullptr));
  check(VecGetArrayRead(diagonal, &values));
  for (Eigen::Index i : holding_rows(comm_, R_)) {
    const auto row = static_cast<PetscInt>(first + i);
    check(MatSetValue(grounded, row, row, values[i], ADD_VALUES));
  }
  check(VecRestoreArrayRead(diagonal, &values));
  check(MatAssemblyBegin(grounded, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(grounded, MAT_FINAL_ASSEMBLY));
  check(MatSetOption(grounded, MAT_SPD, PETSC_TRUE));
  return grounded;
}

}  // namespace elastogear::reduction
