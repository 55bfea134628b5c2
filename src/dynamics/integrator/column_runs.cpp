#include "elastogear/dynamics/column_runs.h"

#include <algorithm>

#include "elastogear/base/instructions.h"

namespace elastogear::dynamics {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

// Four numbers at once, wherever they lie.
typedef double Lanes __attribute__((vector_size(4 * sizeof(double)), aligned(alignof(double)), may_alias));
constexpr Index kLanes = 4;

// The values of a run, n_rows by n_columns, and the rows where they are.
struct Columns {
  const int* row;
  const double* value;
  Index n_rows, n_columns;
};

// y += A x. kRows: rows of A, known to the compiler.
template <Index kRows>
[[gnu::always_inline]] inline void add_product(const Columns& A, const double* x, double* y) {
  if constexpr (kRows % kLanes == 0) {
    Lanes sum[kRows / kLanes] = {};
    for (Index j = 0; j < A.n_columns; ++j)
#pragma GCC unroll 3
      for (Index i = 0; i < kRows / kLanes; ++i)
        sum[i] += *reinterpret_cast<const Lanes*>(A.value + j * kRows + i * kLanes) * x[j];
#pragma GCC unroll 12
    for (Index i = 0; i < kRows; ++i) y[A.row[i]] += sum[i / kLanes][i % kLanes];
  } else {
    double sum[kRows] = {};
    for (Index j = 0; j < A.n_columns; ++j)
#pragma GCC unroll 3
      for (Index i = 0; i < kRows; ++i) sum[i] += A.value[j * kRows + i] * x[j];
#pragma GCC unroll 3
    for (Index i = 0; i < kRows; ++i) y[A.row[i]] += sum[i];
  }
}

// x -= A' y
template <Index kRows>
[[gnu::always_inline]] inline void subtract_projection(const Columns& A, const double* y, double* x) {
  double of_rows[kRows];
#pragma GCC unroll 12
  for (Index i = 0; i < kRows; ++i) of_rows[i] = y[A.row[i]];
  for (Index j = 0; j < A.n_columns; ++j) {
    const double* column = A.value + j * kRows;
    if constexpr (kRows % kLanes == 0) {
      Lanes sum = {};
#pragma GCC unroll 3
      for (Index i = 0; i < kRows; i += kLanes)
        sum += *reinterpret_cast<const Lanes*>(column + i) * *reinterpret_cast<const Lanes*>(of_rows + i);
      x[j] -= (sum[0] + sum[1]) + (sum[2] + sum[3]);
    } else {
      double sum = 0;
#pragma GCC unroll 3
      for (Index i = 0; i < kRows; ++i) sum += column[i] * of_rows[i];
      x[j] -= sum;
    }
  }
}

// y += A x, and below x -= A' y, of columns with any number of rows.
[[gnu::always_inline]] inline void add_any_product(const Columns& A, const double* x, double* y) {
  for (Index j = 0; j < A.n_columns; ++j)
    for (Index i = 0; i < A.n_rows; ++i) y[A.row[i]] += A.value[j * A.n_rows + i] * x[j];
}

[[gnu::always_inline]] inline void subtract_any_projection(const Columns& A, const double* y, double* x) {
  for (Index j = 0; j < A.n_columns; ++j)
    for (Index i = 0; i < A.n_rows; ++i) x[j] -= A.value[j * A.n_rows + i] * y[A.row[i]];
}

// Sizes known to the compiler are those of one node, of the four of a face, and of what a contact's stiffness
// joins: its normal with itself, and the four ways in which it turns.
constexpr Index kNormal = 1, kNode = 3, kTurn = 4, kFace = 12;

// The runs of a matrix, and where its entries are.
struct RunMatrix {
  const std::vector<ColumnRuns::Run>& run;
  const int* row;
  const double* value;

  Columns columns(const ColumnRuns::Run& of) const {
    return {row + of.entry, value + of.entry, of.n_rows, of.n_columns};
  }
};

[[gnu::always_inline]] inline void multiply_all(const RunMatrix& A, const double* x, double* y) {
  for (const ColumnRuns::Run& run : A.run) {
    const Columns columns = A.columns(run);
    const double* x_run = x + run.column;
    switch (run.n_rows) {
      case kNormal:
        add_product<kNormal>(columns, x_run, y);
        break;
      case kNode:
        add_product<kNode>(columns, x_run, y);
        break;
      case kTurn:
        add_product<kTurn>(columns, x_run, y);
        break;
      case kFace:
        add_product<kFace>(columns, x_run, y);
        break;
      default:
        add_any_product(columns, x_run, y);
    }
  }
}

[[gnu::always_inline]] inline void subtract_all(const RunMatrix& A, const double* y, double* x) {
  for (const ColumnRuns::Run& run : A.run) {
    const Columns columns = A.columns(run);
    double* x_run = x + run.column;
    switch (run.n_rows) {
      case kNormal:
        subtract_projection<kNormal>(columns, y, x_run);
        break;
      case kNode:
        subtract_projection<kNode>(columns, y, x_run);
        break;
      case kTurn:
        subtract_projection<kTurn>(columns, y, x_run);
        break;
      case kFace:
        subtract_projection<kFace>(columns, y, x_run);
        break;
      default:
        subtract_any_projection(columns, y, x_run);
    }
  }
}

struct Kernels {
  void (*multiply)(const RunMatrix& A, const double* x, double* y);
  void (*subtract)(const RunMatrix& A, const double* y, double* x);
};

void multiply_portable(const RunMatrix& A, const double* x, double* y) { multiply_all(A, x, y); }
void subtract_portable(const RunMatrix& A, const double* y, double* x) { subtract_all(A, y, x); }

#ifdef __x86_64__
[[gnu::target("avx2,fma")]] void multiply_avx2(const RunMatrix& A, const double* x, double* y) {
  multiply_all(A, x, y);
}
[[gnu::target("avx2,fma")]] void subtract_avx2(const RunMatrix& A, const double* y, double* x) {
  subtract_all(A, y, x);
}
#endif

const Kernels& kernels() {
  static const Kernels best = [] {
#ifdef __x86_64__
    if (best_instructions() != Instructions::portable) return Kernels{multiply_avx2, subtract_avx2};
#endif
    return Kernels{multiply_portable, subtract_portable};
  }();
  return best;
}

}  // namespace

ColumnRuns::ColumnRuns(const Sparse& A) {
  const int *row = A.innerIndexPtr(), *first = A.outerIndexPtr(), *count = A.innerNonZeroPtr();
  for (Index j = 0; j < A.cols(); ++j) {
    const Index entry = first[j], n_rows = count ? count[j] : first[j + 1] - first[j];
    if (n_rows == 0) continue;
    if (!run_.empty()) {
      Run& last = run_.back();
      const bool goes_on = last.column + last.n_columns == j && last.n_rows == n_rows &&
                           last.entry + last.n_columns * n_rows == entry &&
                           std::equal(row + entry, row + entry + n_rows, row + last.entry);
      if (goes_on) {
        ++last.n_columns;
        continue;
      }
    }
    run_.push_back({j, 1, entry, n_rows});
  }
}

VectorXd ColumnRuns::multiply(const Sparse& A, const Eigen::Ref<const VectorXd>& x) const {
  VectorXd y = VectorXd::Zero(A.rows());
  kernels().multiply({run_, A.innerIndexPtr(), A.valuePtr()}, x.data(), y.data());
  return y;
}

void ColumnRuns::subtract_transposed(const Sparse& A, const VectorXd& y, Eigen::Ref<VectorXd> x) const {
  kernels().subtract({run_, A.innerIndexPtr(), A.valuePtr()}, y.data(), x.data());
}

}  // namespace elastogear::dynamics
