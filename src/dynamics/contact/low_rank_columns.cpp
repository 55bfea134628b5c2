#include "dynamics/contact/low_rank_columns.h"

#include <algorithm>

namespace elastogear::dynamics {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

void append_zeros(Index n, MatrixXd& A) {
  A.conservativeResize(Eigen::NoChange, A.cols() + n);
  A.rightCols(n).setZero();
}

// Appends columns with a block in the rows from `row` on, and zeros elsewhere.
void append_block(Index row, const MatrixXd& block, Eigen::SparseMatrix<double>& A) {
  const Index first = A.cols();
  A.makeCompressed();
  A.conservativeResize(A.rows(), first + block.cols());
  std::fill_n(A.outerIndexPtr() + first + 1, block.cols(), 0);  // as of columns that are not begun yet
  A.reserve(block.size());
  for (Index j = 0; j < block.cols(); ++j) {
    A.startVec(first + j);
    for (Index i = 0; i < block.rows(); ++i)
      if (block(i, j) != 0) A.insertBack(row + i, first + j) = block(i, j);
  }
  A.finalize();
}

}  // namespace

Index add_columns(Index n, EffectiveMatrix& A) {
  const Index first = A.k.rows(), r = first + n;
  A.k.conservativeResize(r, r);
  for (BodyTerms& terms : A.body) {
    append_zeros(n, terms.W_s);
    append_zeros(n, terms.V_s);
    for (auto* L : elastic_rows(terms)) L->conservativeResize(L->rows(), r);
  }
  return first;
}

void add_block(Index row, Index column, const MatrixXd& block, Eigen::SparseMatrix<double>& A) {
  for (Index j = 0; j < block.cols(); ++j)
    for (Index i = 0; i < block.rows(); ++i)
      if (block(i, j) != 0) A.coeffRef(row + i, column + j) += block(i, j);
}

std::vector<Eigen::SparseMatrix<double>*> elastic_rows(BodyTerms& terms) {
  std::vector<Eigen::SparseMatrix<double>*> all{&terms.L};
  if (terms.L_V.rows() > 0) all.push_back(&terms.L_V);
  if (terms.L_x.rows() > 0) all.push_back(&terms.L_x);
  return all;
}

const Eigen::SparseMatrix<double>& displacement_rows(const BodyTerms& terms) {
  return terms.L_V.rows() > 0 ? terms.L_V : terms.L;
}

const Eigen::SparseMatrix<double>& position_rows(const BodyTerms& terms) {
  return terms.L_x.rows() > 0 ? terms.L_x : displacement_rows(terms);
}

void add_border_stiffness(const MatrixXd& Z, std::size_t b, EffectiveMatrix& A) {
  if (Z.size() == 0) return;
  const Index first = A.k.rows(), n = Z.rows();
  A.k.conservativeResize(first + n, first);
  append_block(first, Z, A.k);
  for (std::size_t other = 0; other < A.body.size(); ++other) {
    BodyTerms& terms = A.body[other];
    append_zeros(n, terms.W_s);
    append_zeros(n, terms.V_s);
    const MatrixXd border = MatrixXd::Identity(other == b ? n : 0, n);
    for (auto* L : elastic_rows(terms)) append_block(0, border, *L);
  }
}

}  // namespace elastogear::dynamics
