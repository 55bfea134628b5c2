#include "reduction/eigensolver/block_product.h"

#include <algorithm>
#include <array>

#include "elastogear/base/instructions.h"

namespace elastogear::reduction {
namespace {

constexpr int kWidth = 8;  // columns that fit into registers together

typedef double Chunk
    __attribute__((vector_size(kWidth * sizeof(double)), aligned(alignof(double)), may_alias));

// Part of a row times columns of X, whose rows have `stride` entries.
struct Entries {
  PetscInt n;
  const PetscInt* column;
  const PetscScalar* value;
  const double* X;
  Eigen::Index stride;
};

[[gnu::always_inline]] inline void add(const Entries& row, double* sums) {
  Chunk total = *reinterpret_cast<const Chunk*>(sums);
  for (PetscInt k = 0; k < row.n; ++k)
    total += row.value[k] * *reinterpret_cast<const Chunk*>(row.X + row.column[k] * row.stride);
  *reinterpret_cast<Chunk*>(sums) = total;
}

void add_portable(const Entries& row, double* sums) { add(row, sums); }

#ifdef __x86_64__
[[gnu::target("avx2,fma")]] void add_avx2(const Entries& row, double* sums) { add(row, sums); }
[[gnu::target("avx512f")]] void add_avx512(const Entries& row, double* sums) { add(row, sums); }
#endif

using Add = void (*)(const Entries&, double*);

Add best_add() {
#ifdef __x86_64__
  if (best_instructions() == Instructions::avx512) return add_avx512;
  if (best_instructions() == Instructions::avx2) return add_avx2;
#endif
  return add_portable;
}

bool is_serial(MPI_Comm comm) {
  int size = 1;
  MPI_Comm_size(comm, &size);
  return size == 1;
}

}  // namespace

BlockProduct::BlockProduct(Mat A, Storage storage) : comm_(comm_of(A)) {
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
  const Add add = best_add();
  const auto add_row = [&](const Rows& part, int i, const double* x, double* sum) {
    const PetscInt begin = part.offset[i];
    add({part.offset[i + 1] - begin, part.column + begin, part.value + begin, x, padded}, sum);
  };
  Eigen::MatrixXd product(n_own_, n_columns);
  for (int i = 0; i < n_own_; ++i)
    for (Eigen::Index j = 0; j < padded; j += kWidth) {
      std::array<double, kWidth> sum = {};
      add_row(own_.rows, i, rows.data() + j, sum.data());
      if (n_ghost_ > 0) add_row(ghost_.rows, i, rows.data() + n_own_ * padded + j, sum.data());
      for (Eigen::Index k = 0; k < std::min<Eigen::Index>(kWidth, n_columns - j); ++k)
        product(i, j + k) = sum[k];
    }
  return product;
}

}  // namespace elastogear::reduction
