#include "reduction/eigensolver/nested_factor.h"

#include <algorithm>
#include <utility>

#include "reduction/dense/dense_blas.h"
#include "reduction/dense/dense_inverse.h"
#include "reduction/dense/residual.h"
#include "reduction/nested/csr_view.h"

namespace elastogear::reduction {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// The least reciprocal condition number of a pivot's matrix where eigenvalues lie below the shift. A smaller
// one costs the digits that counting and solving need.
constexpr double kLeastCondition = 1e-9;
constexpr Index kTogetherInProduct = 256;  // of a symmetric product that are formed together

// The lower triangle of S_BB := S_BB - H S_IB.
void subtract_symmetric(const MatrixXd& H, const MatrixXd& S_BI, MatrixXd& S_BB) {
  for (Index first = 0; first < S_BB.cols(); first += kTogetherInProduct) {
    const Index n = std::min(kTogetherInProduct, S_BB.cols() - first), rows = S_BB.rows() - first;
    multiply(Op::plain, Op::transposed, -1, H.bottomRows(rows), S_BI.middleRows(first, n), 1,
             S_BB.block(first, first, rows, n));
  }
}

}  // namespace

NestedFactor::NestedFactor(Mat K, Mat M, int largest_leaf)
    : K_(K), M_(M), tree_(make_tree(K, Eigen::SparseMatrix<double>(0, CsrView(K).n()), largest_leaf, {})) {
  place_.assign(tree_.at.size(), -1);
}

Front NestedFactor::make_front(const TreePart& part, double sigma) {
  const int n_inner = part.n_rows();
  for (int i = part.first; i < part.end; ++i) place_[i] = i - part.first;
  for (std::size_t i = 0; i < part.border.size(); ++i) place_[part.border[i]] = n_inner + static_cast<int>(i);
  Front front(n_inner, static_cast<Index>(part.border.size()), 0);
  const auto add_entries = [&](Mat A, double factor) {
    const CsrView rows(A);
    for (int i = part.first; i < part.end; ++i)
      rows.visit_row(tree_.at[i], [&](int column, double value) {
        const int j = tree_.position[column], place = j < part.first ? -1 : place_[j], own = i - part.first;
        if (place >= n_inner)
          front.S_BI(place - n_inner, own) += factor * value;
        else if (place >= own)
          front.S_II(place, own) += factor * value;
      });
  };
  add_entries(K_, 1);
  if (sigma != 0) add_entries(M_, -sigma);
  return front;
}

void NestedFactor::add(int child, Front& front) {
  if (child < 0) return;
  std::vector<int> place;
  for (int i : tree_.part[child].border) place.push_back(place_[i]);
  add_child(std::exchange(condensed_[child], {}), place, {}, front);
}

// Returns the number of negative eigenvalues, or none where a pivot is nearly singular.
std::optional<int> NestedFactor::eliminate_parts(double sigma, bool keep) {
  int n_negative = 0;
  double condition = 1;
  condensed_.resize(tree_.part.size());
  panel_.clear();
  for (std::size_t i = 0; i < tree_.part.size(); ++i) {
    const TreePart& part = tree_.part[i];
    Front front = make_front(part, sigma);
    add(part.left, front);
    add(part.right, front);
    const Inverted inverted = invert_symmetric(front.S_II);
    n_negative += inverted.n_negative;
    condition = std::min(condition, inverted.condition);
    if (inverted.condition == 0 || (n_negative > 0 && condition < kLeastCondition)) return {};
    const Index n = front.n_inner(), n_border = front.S_BI.rows();
    MatrixXd H(n_border, n);
    multiply(Op::plain, Op::plain, 1, front.S_BI, front.S_II, 0, H);
    subtract_symmetric(H, front.S_BI, front.S_BB);
    condensed_[i] = {std::move(front.S_BB), MatrixXd(0, n_border)};
    if (!keep) continue;
    MatrixXd both(n_border + n, n);
    both << -H, front.S_II;
    panel_.emplace_back(both.rows(), static_cast<int>(n)).set(0, both);
  }
  return n_negative;
}

int NestedFactor::eliminate(double sigma, bool keep) {
  whole_.reset();
  const std::optional<int> n_negative = eliminate_parts(sigma, keep);
  condensed_.clear();
  if (n_negative) return *n_negative;
  panel_.clear();
  whole_ = std::make_unique<ShiftedFactor>(K_, M_);
  return whole_->factorise(sigma);
}

// Forwards b_B := b_B - S_BI S_II^-1 b_I, then back x_I := S_II^-1 b_I - S_II^-1 S_IB x_B.
void NestedFactor::solve(Eigen::Ref<MatrixXd> B) {
  if (whole_) return whole_->solve(B);
  RowMajor X = B(tree_.at, Eigen::all);
  MatrixXd own, border;
  for (std::size_t i = 0; i < tree_.part.size(); ++i) {
    const TreePart& part = tree_.part[i];
    own = X.middleRows(part.first, part.n_rows());
    border.setZero(static_cast<Index>(part.border.size()), B.cols());
    panel_[i].add_product(0, own, border);
    for (Index j = 0; j < border.rows(); ++j) X.row(part.border[j]) += border.row(j);
  }
  for (std::size_t i = tree_.part.size(); i-- > 0;) {
    const TreePart& part = tree_.part[i];
    const auto n_border = static_cast<Index>(part.border.size());
    border.resize(n_border + part.n_rows(), B.cols());
    for (Index j = 0; j < n_border; ++j) border.row(j) = X.row(part.border[j]);
    border.bottomRows(part.n_rows()) = X.middleRows(part.first, part.n_rows());
    X.middleRows(part.first, part.n_rows()) = panel_[i].dot(part.n_rows(), border);
  }
  B(tree_.at, Eigen::all) = X;
}

FactorSize NestedFactor::size() const {
  FactorSize size;
  for (const TreePart& part : tree_.part) {
    const double n = part.n_rows(), border = static_cast<double>(part.border.size());
    size.entries += n * (n / 2 + border);
    size.flops += n * (n * n + border * (2 * n + border));
  }
  return size;
}

}  // namespace elastogear::reduction
