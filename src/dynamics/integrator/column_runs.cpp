#include "elastogear/dynamics/column_runs.h"

#include <algorithm>

namespace elastogear::dynamics {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

// The columns of a run: rows, and a dense matrix.
template <int kRows>
struct Columns {
  const int* row;
  Eigen::Map<const Eigen::Matrix<double, kRows, Eigen::Dynamic>> value;
};

template <int kRows>
void add_product(const Columns<kRows>& A, const double* x, VectorXd& y) {
  Eigen::Matrix<double, kRows, 1> sum = A.value.col(0) * x[0];
  for (Index j = 1; j < A.value.cols(); ++j) sum += A.value.col(j) * x[j];
  for (Index i = 0; i < A.value.rows(); ++i) y[A.row[i]] += sum[i];
}

template <int kRows>
void subtract_projection(const Columns<kRows>& A, const VectorXd& y, double* x) {
  Eigen::Matrix<double, kRows, 1> of_rows(A.value.rows());
  for (Index i = 0; i < A.value.rows(); ++i) of_rows[i] = y[A.row[i]];
  for (Index j = 0; j < A.value.cols(); ++j) x[j] -= A.value.col(j).dot(of_rows);
}

// Calls task(Columns<n>), with n known to the compiler for one node, for the four of a face, and for what a
// contact's stiffness joins: its normal with itself, and the four ways in which it turns.
template <class Task>
void with_columns(const Sparse& A, Index entry, Index n_rows, Index n_columns, const Task& task) {
  constexpr int kNormal = 1, kNode = 3, kTurn = 4, kFace = 12;
  const int* row = A.innerIndexPtr() + entry;
  const double* value = A.valuePtr() + entry;
  if (n_rows == kNormal) return task(Columns<kNormal>{row, {value, n_rows, n_columns}});
  if (n_rows == kNode) return task(Columns<kNode>{row, {value, n_rows, n_columns}});
  if (n_rows == kTurn) return task(Columns<kTurn>{row, {value, n_rows, n_columns}});
  if (n_rows == kFace) return task(Columns<kFace>{row, {value, n_rows, n_columns}});
  task(Columns<Eigen::Dynamic>{row, {value, n_rows, n_columns}});
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
  for (const Run& run : run_)
    with_columns(A, run.entry, run.n_rows, run.n_columns,
                 [&](const auto& columns) { add_product(columns, x.data() + run.column, y); });
  return y;
}

void ColumnRuns::subtract_transposed(const Sparse& A, const VectorXd& y, Eigen::Ref<VectorXd> x) const {
  for (const Run& run : run_)
    with_columns(A, run.entry, run.n_rows, run.n_columns,
                 [&](const auto& columns) { subtract_projection(columns, y, x.data() + run.column); });
}

}  // namespace elastogear::dynamics
