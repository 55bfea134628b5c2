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
  own_.A = A;
  if (!is_serial(comm_)) {
    const PetscInt* global = nullptr;
    check(MatMPIAIJGetSeqAIJ(A, &own_.A, &ghost_.A, &global));
    find_ghosts(A, global);
  }
  for (Part* part : {&own_, &ghost_}) {
    open(*part);
    if (storage == Storage::without_zeros) drop_zeros(*part, n_own_);
  }
}

BlockProduct::~BlockProduct() {
  close(own_);
  close(ghost_);
}

// global: the column of A of each column of ghost_.
void BlockProduct::find_ghosts(Mat A, const PetscInt* global) {
  PetscLayout layout = nullptr;
  PetscInt n = 0;
  check(MatGetSize(ghost_.A, nullptr, &n));
  n_ghost_ = static_cast<int>(n);
  check(MatGetLayouts(A, &layout, nullptr));
  check(PetscSFCreate(comm_, ghosts_.out()));
  check(PetscSFSetGraphLayout(ghosts_, layout, n_ghost_, nullptr, PETSC_COPY_VALUES, global));
  check(PetscSFSetUp(ghosts_));
}

void BlockProduct::open(Part& part) {
  if (!part.A) return;
  PetscInt n = 0;
  PetscBool done = PETSC_FALSE;
  check(MatGetRowIJ(part.A, 0, PETSC_FALSE, PETSC_FALSE, &n, &part.rows.offset, &part.rows.column, &done));
  check(MatSeqAIJGetArrayRead(part.A, &part.rows.value));
}

void BlockProduct::close(Part& part) {
  if (!part.A) return;
  PetscInt n = 0;
  PetscBool done = PETSC_FALSE;
  check(MatSeqAIJRestoreArrayRead(part.A, &part.rows.value));
  check(
      MatRestoreRowIJ(part.A, 0, PETSC_FALSE, PETSC_FALSE, &n, &part.rows.offset, &part.rows.column, &done));
  part.A = nullptr;
}

void BlockProduct::drop_zeros(Part& part, int n_rows) {
  if (!part.A) return;
  part.offset.assign(1, 0);
  for (int i = 0; i < n_rows; ++i) {
    for (PetscInt k = part.rows.offset[i]; k < part.rows.offset[i + 1]; ++k) {
      if (part.rows.value[k] == 0) continue;
      part.column.push_back(part.rows.column[k]);
      part.value.push_back(part.rows.value[k]);
    }
    part.offset.push_back(static_cast<PetscInt>(part.column.size()));
  }
  close(part);
  part.rows = {part.offset.data(), part.column.data(), part.value.data()};
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
  const auto add_row = [padded](const Rows& part, int i, const double* x, Chunk& sum) {
    for (PetscInt k = part.offset[i]; k < part.offset[i + 1]; ++k)
      sum += part.value[k] * ConstChunk(x + part.column[k] * padded);
  };
  Eigen::MatrixXd product(n_own_, n_columns);
  for (int i = 0; i < n_own_; ++i)
    for (Eigen::Index j = 0; j < padded; j += kWidth) {
      Chunk sum = Chunk::Zero();
      add_row(own_.rows, i, rows.data() + j, sum);
      if (n_ghost_ > 0) add_row(ghost_.rows, i, rows.data() + n_own_ * padded + j, sum);
      const Eigen::Index width = std::min<Eigen::Index>(kWidth, n_columns - j);
      product.row(i).segment(j, width) = sum.head(width).matrix().transpose();
    }
  return product;
}

}  // namespace elastogear::reduction
