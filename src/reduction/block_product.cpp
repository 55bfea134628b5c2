#include "elastogear/reduction/block_product.h"

#include <algorithm>

namespace elastogear::reduction {
namespace {

constexpr int kWidth = 8;  // columns that fit into registers together

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

void BlockProduct::fetch_ghosts() const {
  if (!ghosts_) return;
  const auto n_columns = static_cast<int>(buffer_.cols());
  double* own = buffer_.data();
  double* ghosts = own + static_cast<std::ptrdiff_t>(n_own_) * n_columns;
  MPI_Datatype row = MPI_DATATYPE_NULL;
  MPI_Type_contiguous(n_columns, MPI_DOUBLE, &row);
  MPI_Type_commit(&row);
  check(PetscSFBcastBegin(ghosts_, row, own, ghosts, MPI_REPLACE));
  check(PetscSFBcastEnd(ghosts_, row, own, ghosts, MPI_REPLACE));
  MPI_Type_free(&row);
}

Eigen::MatrixXd BlockProduct::operator()(const Eigen::Ref<const Eigen::MatrixXd>& X) const {
  const Eigen::Index n_columns = X.cols(), padded = (n_columns + kWidth - 1) / kWidth * kWidth;
  RowMajor& rows = buffer_;
  rows.resize(n_own_ + n_ghost_, padded);
  rows.topLeftCorner(n_own_, n_columns) = X;
  rows.topRightCorner(n_own_, padded - n_columns).setZero();
  fetch_ghosts();
  Eigen::MatrixXd product(n_own_, n_columns);
  for (int i = 0; i < n_own_; ++i)
    for (Eigen::Index j = 0; j < padded; j += kWidth) {
      Chunk sum = Chunk::Zero();
      for (PetscInt k = rows_.offset[i]; k < rows_.offset[i + 1]; ++k)
        sum += rows_.value[k] * ConstChunk(rows.data() + rows_.column[k] * padded + j);
      const Eigen::Index width = std::min<Eigen::Index>(kWidth, n_columns - j);
      product.row(i).segment(j, width) = sum.head(width).matrix().transpose();
    }
  return product;
}

}  // namespace elastogear::reduction
