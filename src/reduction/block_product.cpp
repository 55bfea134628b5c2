#include "elastogear/reduction/block_product.h"

namespace elastogear::reduction {
namespace {

constexpr int kWidth = 8;  // columns that fit into registers together

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Chunk = Eigen::Array<double, kWidth, 1>;
using ConstChunk = Eigen::Map<const Chunk>;

bool is_serial(MPI_Comm comm) {
  int size = 1;
  MPI_Comm_size(comm, &size);
  return size == 1;
}

}  // namespace

BlockProduct::BlockProduct(Mat A, Storage storage)
    : comm_(PetscObjectComm(reinterpret_cast<PetscObject>(A))) {
  PetscInt n_own = 0, n = 0;
  check(MatGetLocalSize(A, &n_own, nullptr));
  check(MatGetSize(A, &n, nullptr));
  n_own_ = static_cast<int>(n_own);
  n_ = static_cast<int>(n);
  if (is_serial(comm_))
    local_ = A;
  else
    find_ghosts(A);
  PetscBool done = PETSC_FALSE;
  check(MatGetRowIJ(local_, 0, PETSC_FALSE, PETSC_FALSE, &n, &rows_.offset, &rows_.column, &done));
  check(MatSeqAIJGetArrayRead(local_, &rows_.value));
  if (storage == Storage::without_zeros) drop_zeros();
}

BlockProduct::~BlockProduct() {
  if (local_) release();
}

// The ghosts follow the own columns in the order of merged_.
void BlockProduct::find_ghosts(Mat A) {
  UniqueIS columns;
  PetscLayout layout = nullptr;
  const PetscInt* global = nullptr;
  PetscInt n = 0;
  check(MatMPIAIJGetLocalMatMerge(A, MAT_INITIAL_MATRIX, columns.out(), merged_.out()));
  local_ = merged_;
  check(ISGetSize(columns, &n));
  n_ghost_ = static_cast<int>(n) - n_own_;
  check(ISGetIndices(columns, &global));
  check(MatGetLayouts(A, &layout, nullptr));
  check(PetscSFCreate(comm_, ghosts_.out()));
  check(PetscSFSetGraphLayout(ghosts_, layout, n_ghost_, nullptr, PETSC_COPY_VALUES, global + n_own_));
  check(PetscSFSetUp(ghosts_));
  check(ISRestoreIndices(columns, &global));
}

void BlockProduct::drop_zeros() {
  offset_.assign(1, 0);
  for (int i = 0; i < n_own_; ++i) {
    for (PetscInt k = rows_.offset[i]; k < rows_.offset[i + 1]; ++k) {
      if (rows_.value[k] == 0) continue;
      column_.push_back(rows_.column[k]);
      value_.push_back(rows_.value[k]);
    }
    offset_.push_back(static_cast<PetscInt>(column_.size()));
  }
  release();
  rows_ = {offset_.data(), column_.data(), value_.data()};
}

void BlockProduct::release() {
  PetscInt n = 0;
  PetscBool done = PETSC_FALSE;
  check(MatSeqAIJRestoreArrayRead(local_, &rows_.value));
  check(MatRestoreRowIJ(local_, 0, PETSC_FALSE, PETSC_FALSE, &n, &rows_.offset, &rows_.column, &done));
  local_ = nullptr;
  merged_ = {};
}

Eigen::MatrixXd BlockProduct::operator()(const Eigen::Ref<const Eigen::MatrixXd>& X) const {
  const Eigen::Index n_columns = X.cols(), padded = (n_columns + kWidth - 1) / kWidth * kWidth;
  RowMajor rows(n_own_ + n_ghost_, padded), product(n_own_, padded);
  rows.topLeftCorner(n_own_, n_columns) = X;
  rows.topRightCorner(n_own_, padded - n_columns).setZero();
  if (ghosts_) {
    MPI_Datatype row = MPI_DATATYPE_NULL;
    MPI_Type_contiguous(static_cast<int>(padded), MPI_DOUBLE, &row);
    MPI_Type_commit(&row);
    check(PetscSFBcastBegin(ghosts_, row, rows.data(), rows.data() + n_own_ * padded, MPI_REPLACE));
    check(PetscSFBcastEnd(ghosts_, row, rows.data(), rows.data() + n_own_ * padded, MPI_REPLACE));
    MPI_Type_free(&row);
  }
  for (int i = 0; i < n_own_; ++i)
    for (Eigen::Index j = 0; j < padded; j += kWidth) {
      Chunk sum = Chunk::Zero();
      for (PetscInt k = rows_.offset[i]; k < rows_.offset[i + 1]; ++k)
        sum += rows_.value[k] * ConstChunk(rows.data() + rows_.column[k] * padded + j);
      Eigen::Map<Chunk>(product.data() + i * padded + j) = sum;
    }
  return product.leftCols(n_columns);
}

}  // namespace elastogear::reduction
