#include "reduction/static_response/nested_response.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "elastogear/base/sort_unique.h"
#include "reduction/dense/dense_blas.h"
#include "reduction/eigensolver/factorisation.h"
#include "reduction/static_response/csr_view.h"
#include "reduction/static_response/dissection.h"
#include "reduction/static_response/residual.h"

namespace elastogear::reduction {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::MatrixXf;
using ByColumn = Eigen::SparseMatrix<double>;
using ByRow = model::SparseRows;

constexpr Index kLeafColumns = 128;   // right-hand sides that go through a leaf's factor together
constexpr int kLargestLeaf = 1500;    // rows of K, where there are separators
constexpr std::size_t kGroup = 1024;  // loads that go through the parts together
constexpr Index kBalanced = 64;       // of them, that are balanced together

int position(const std::vector<int>& sorted, int value) {
  const auto at = std::lower_bound(sorted.begin(), sorted.end(), value);
  return at != sorted.end() && *at == value ? static_cast<int>(at - sorted.begin()) : -1;
}

std::vector<int> positions_in(const std::vector<int>& sorted, const std::vector<int>& values) {
  std::vector<int> at;
  for (int value : values) at.push_back(position(sorted, value));
  return at;
}

// Rows of one block of a sequential matrix as PETSc's; keeps what it points to.
struct OwnedMat {
  std::vector<PetscInt> offset{0}, column = {};
  std::vector<PetscScalar> value = {};
  UniqueMat mat = {};

  void finish() {
    const auto n = static_cast<PetscInt>(offset.size()) - 1;
    check(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, n, n, offset.data(), column.data(), value.data(),
                                    mat.out()));
  }
};

}  // namespace

template <class T>
class NestedResponse::Elimination {
 public:
  Elimination(Mat K, const ByRow& P, const std::vector<int>& loads, int largest_leaf,
              const std::vector<int>& kept = {})
      : K_(K),
        P_(P),
        is_load_(static_cast<std::size_t>(P.rows()), 0),
        parts_(dissect(K, largest_leaf, kept)),
        at_(static_cast<std::size_t>(K_.n()), -1),
        is_eliminated_(at_.size(), 0),
        condensed_(parts_.size()) {
    for (int load : loads) is_load_[load] = 1;
  }

  Contributions<T> run() {
    for (std::size_t i = 0; i < parts_.size(); ++i)
      parts_[i].is_leaf() ? condense_leaf(parts_[i], condensed_[i])
                          : condense_separator(parts_[i], condensed_[i]);
    return std::move(contributions_);
  }

  // The Schur complement of the kept rows and the wanted rows by them; to be called after run().
  KeptRows left_at(const std::vector<int>& kept) {
    const Part border{kept};
    mark(border);
    KeptRows left{entries(kept, border), wanted_entries(border, all_wanted())};
    const Condensed root = std::move(condensed_.back());
    const std::vector<int> at = positions_in(kept, root.border);
    left.S(at, at) += root.S;
    left.E(root.row, at) += root.E;
    return left;
  }

 private:
  std::vector<int> all_wanted() const {
    std::vector<int> rows(static_cast<std::size_t>(P_.rows()));
    std::iota(rows.begin(), rows.end(), 0);
    return rows;
  }

  void mark(const Part& part) {
    for (std::size_t i = 0; i < part.row.size(); ++i) at_[part.row[i]] = static_cast<int>(i);
  }
  void eliminate(const Part& part) {
    for (int row : part.row) at_[row] = -1, is_eliminated_[row] = 1;
  }

  // Rows of K outside of the part, whose own rows are marked, that have entries in it and are not eliminated.
  std::vector<int> neighbours(const Part& part) const {
    std::vector<int> border;
    for (int row : part.row)
      K_.visit_row(row, [&](int column, double) {
        if (at_[column] < 0 && !is_eliminated_[column]) border.push_back(column);
      });
    sort_unique(border);
    return border;
  }

  // Rows of P with entries in the part.
  std::vector<int> wanted_rows(const Part& part) const {
    std::vector<int> rows;
    for (int column : part.row)
      for (ByColumn::InnerIterator it(P_, column); it; ++it) rows.push_back(static_cast<int>(it.row()));
    sort_unique(rows);
    return rows;
  }

  // Entries of P in these of its rows and in the part.
  ByRow wanted_entries(const Part& part, const std::vector<int>& rows) const {
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t j = 0; j < part.row.size(); ++j)
      for (ByColumn::InnerIterator it(P_, part.row[j]); it; ++it)
        entries.emplace_back(position(rows, static_cast<int>(it.row())), static_cast<int>(j), it.value());
    ByRow P(static_cast<Index>(rows.size()), static_cast<Index>(part.row.size()));
    P.setFromTriplets(entries.begin(), entries.end());
    return P;
  }

  // Entries of K in these rows and in the part, whose rows are marked.
  ByRow entries(const std::vector<int>& rows, const Part& part) const {
    std::vector<Eigen::Triplet<double>> values;
    for (std::size_t i = 0; i < rows.size(); ++i)
      K_.visit_row(rows[i], [&](int column, double value) {
        if (at_[column] >= 0) values.emplace_back(static_cast<int>(i), at_[column], value);
      });
    ByRow K(static_cast<Index>(rows.size()), static_cast<Index>(part.row.size()));
    K.setFromTriplets(values.begin(), values.end());
    return K;
  }

  OwnedMat inner_matrix(const Part& part) const {
    OwnedMat K;
    for (int row : part.row) {
      K_.visit_row(row, [&](int column, double value) {
        if (at_[column] < 0) return;
        K.column.push_back(at_[column]);
        K.value.push_back(value);
      });
      K.offset.push_back(static_cast<PetscInt>(K.column.size()));
    }
    K.finish();
    return K;
  }

  // Eq. (6.20a): S = -K_BI K_II^-1 K_IB (the entries of K_BB follow with the separators), E = -P_I K_II^-1
  // K_IB and the response P_I K_II^-1 P_I'.
  void condense_leaf(const Part& part, Condensed& result) {
    mark(part);
    result.border = neighbours(part);
    result.row = wanted_rows(part);
    const ByRow K_BI = entries(result.border, part), P_I = wanted_entries(part, result.row);
    const OwnedMat K_II = inner_matrix(part);
    eliminate(part);
    ShiftedFactor factor(K_II.mat, nullptr);
    if (factor.factorise(0) > 0) fail_singular("a pivot is negative");
    const auto solve = [&](const ByRow& rows, Index first, Index n) {
      MatrixXd X = MatrixXd(rows.middleRows(first, n)).transpose();
      factor.solve(X);
      return X;
    };
    const Index n_border = K_BI.rows();
    result.S.resize(n_border, n_border);
    result.E.resize(P_I.rows(), n_border);
    for (Index first = 0; first < n_border; first += kLeafColumns) {
      const Index n = std::min(kLeafColumns, n_border - first);
      const MatrixXd X = solve(K_BI, first, n);
      result.S.middleCols(first, n) = -(K_BI * X);
      result.E.middleCols(first, n) = -(P_I * X);
    }
    Contribution<T> c{.row = result.row};
    std::vector<Eigen::Triplet<double>> selected;
    for (std::size_t i = 0; i < c.row.size(); ++i)
      if (is_load_[c.row[i]]) {
        selected.emplace_back(static_cast<int>(c.load.size()), static_cast<int>(i), 1.0);
        c.load.push_back(c.row[i]);
      }
    const auto n_loads = static_cast<Index>(c.load.size());
    ByRow selection(n_loads, P_I.rows());
    selection.setFromTriplets(selected.begin(), selected.end());
    const ByRow P_load = selection * P_I;
    c.response.resize(P_I.rows(), n_loads);
    for (Index first = 0; first < n_loads; first += kLeafColumns) {
      const Index n = std::min(kLeafColumns, n_loads - first);
      c.response.middleCols(first, n) = (P_I * solve(P_load, first, n)).template cast<T>();
    }
    if (n_loads > 0) contributions_.push_back(std::move(c));
  }

  // The union of what both children leave, and what the separator adds.
  static std::vector<int> joined(std::vector<int> a, const std::vector<int>& b, const std::vector<int>& c) {
    a.insert(a.end(), b.begin(), b.end());
    a.insert(a.end(), c.begin(), c.end());
    sort_unique(a);
    return a;
  }

  // Schur complements S and right-hand sides E of a separator I and the border B around it, before the
  // separator is eliminated.
  struct Front {
    MatrixXd S_II, S_BI, S_BB, E_I, E_B;
  };

  // Adds a child's matrices to those of the front.
  static void add_child(const Part& part, const Condensed& child, const Condensed& parent, Front& front) {
    const std::vector<int> inner = positions_in(part.row, child.border),
                           border = positions_in(parent.border, child.border),
                           row = positions_in(parent.row, child.row);
    const auto n = static_cast<Index>(child.border.size());
    for (Index j = 0; j < n; ++j)
      for (Index i = 0; i < n; ++i) {
        const int I = inner[i], B = border[i], I_j = inner[j], B_j = border[j];
        if (I >= 0 && I_j >= 0) front.S_II(I, I_j) += child.S(i, j);
        if (B >= 0 && I_j >= 0) front.S_BI(B, I_j) += child.S(i, j);
        if (B >= 0 && B_j >= 0) front.S_BB(B, B_j) += child.S(i, j);
      }
    for (Index j = 0; j < n; ++j) {
      auto to = inner[j] >= 0 ? front.E_I.col(inner[j]) : front.E_B.col(border[j]);
      for (std::size_t i = 0; i < row.size(); ++i) to[row[i]] += child.E(static_cast<Index>(i), j);
    }
  }

  Front make_front(const Part& part, const Condensed& parent) const {
    const auto n_I = static_cast<Index>(part.row.size()), n_B = static_cast<Index>(parent.border.size()),
               n_rows = static_cast<Index>(parent.row.size());
    Front front{MatrixXd::Zero(n_I, n_I), MatrixXd(), MatrixXd::Zero(n_B, n_B), MatrixXd::Zero(n_rows, n_I),
                MatrixXd::Zero(n_rows, n_B)};
    front.S_II += entries(part.row, part);
    front.S_BI = entries(parent.border, part);
    front.E_I += wanted_entries(part, parent.row);
    return front;
  }

  // Eq. (6.20a). With S_II = L L' and C = E_I L^-T: S = S_BB - S_BI S_II^-1 S_IB, E = E_B - E_I S_II^-1 S_IB,
  // and C C' is added to the responses.
  void condense_separator(const Part& part, Condensed& result) {
    Condensed left = std::move(condensed_[part.left]), right = std::move(condensed_[part.right]);
    mark(part);
    result.border = joined(left.border, right.border, neighbours(part));
    std::erase_if(result.border, [&](int row) { return at_[row] >= 0; });
    result.row = joined(left.row, right.row, wanted_rows(part));
    Front front = make_front(part, result);
    eliminate(part);
    for (Condensed* child : {&left, &right}) {
      add_child(part, *child, result, front);
      *child = {};
    }
    if (!cholesky(front.S_II)) fail_singular("a part of it is not positive definite");
    solve_lower_transposed_right(front.S_II, front.S_BI);
    solve_lower_transposed_right(front.S_II, front.E_I);
    multiply(Op::plain, Op::transposed, -1, front.S_BI, front.S_BI, 1, front.S_BB);
    multiply(Op::plain, Op::transposed, -1, front.E_I, front.S_BI, 1, front.E_B);
    result.S = std::move(front.S_BB);
    result.E = std::move(front.E_B);
    contributions_.push_back({.row = result.row, .C = front.E_I.template cast<T>()});
  }

  CsrView K_;
  ByColumn P_;
  std::vector<char> is_load_;
  std::vector<Part> parts_;
  std::vector<int> at_;  // of each row of K: its place in the part at hand, -1: not in it
  std::vector<char> is_eliminated_;
  std::vector<Condensed> condensed_;
  Contributions<T> contributions_;
};

namespace {

// P with rows for the inertia forces of rigid motions below.
ByRow with_inertia(const ByRow& P, const MatrixXd& M_R) {
  const ByRow rigid = M_R.transpose().sparseView(0, 0);
  ByRow all(P.rows() + rigid.rows(), P.cols());
  all.topRows(P.rows()) = P;
  all.bottomRows(rigid.rows()) = rigid;
  return all;
}

// The columns of all separators in order, as far as that saves time.
template <class T>
Contributions<T> ordered(Contributions<T> contributions, const std::vector<int>& loads, Index n_rows) {
  std::vector<char> is_load(static_cast<std::size_t>(n_rows), 0);
  for (int load : loads) is_load[load] = 1;
  const Eigen::VectorXd scale = row_scales(contributions, static_cast<int>(n_rows));
  for (Contribution<T>& c : contributions)
    if (c.C.size() > 0) order_columns(is_load, scale, c);
  return contributions;
}

}  // namespace

// Nested: separators by the square of the unknowns, leaves by their rows and by the loads in them, products
// of wanted rows and loads, of loads with each other half of them, by the size of the largest separator.
// Whole: factor and solutions after nested dissection (docs/performance.md).
ResponseFlops response_flops(double unknowns, double wanted, double n_loads) {
  constexpr double kSeparators = 20, kLeafRow = 0.8e6, kLeafLoad = 4e6, kEntries = 17, kFactor = 8;
  const double squared = unknowns * unknowns;
  return {kSeparators * squared + kLeafRow * unknowns + kLeafLoad * n_loads +
              (2 * wanted - n_loads) * n_loads * std::pow(unknowns, 2. / 3),
          kFactor * squared + 4 * kEntries * std::pow(unknowns, 4. / 3) * n_loads};
}

NestedResponse::NestedResponse(Mat K, const ByRow& P, const std::vector<int>& loads, const RigidFields& rigid,
                               int largest_leaf)
    : n_rows_(P.rows() + rigid.M_R.cols()) {
  if (largest_leaf == 0) {
    const auto [nested, whole] = response_flops(static_cast<double>(P.cols()), static_cast<double>(P.rows()),
                                                static_cast<double>(loads.size()));
    largest_leaf = nested < whole ? kLargestLeaf : static_cast<int>(P.cols());
  }
  std::vector<int> all = loads;
  for (Index i = P.rows(); i < n_rows_; ++i) all.push_back(static_cast<int>(i));
  if (rigid.M_R.cols() > 0)
    contributions_ =
        ordered(Elimination<double>(K, with_inertia(P, rigid.M_R), all, largest_leaf).run(), all, n_rows_);
  else
    contributions_ = ordered(Elimination<float>(K, P, all, largest_leaf).run(), all, n_rows_);
  group(loads);
  if (rigid.M_R.cols() > 0) balance(P, rigid);
}

NestedResponse::NestedResponse(Mat K, const ByRow& P, const std::vector<int>& loads,
                               const std::vector<int>& kept, KeptRows& left)
    : n_rows_(P.rows()) {
  Elimination<double> elimination(K, P, loads, kLargestLeaf, kept);
  contributions_ = ordered(elimination.run(), loads, n_rows_);
  left = elimination.left_at(kept);
  group(loads);
}

// With the inertia forces M R of unit rigid accelerations: drift = P K^-1 M R - P R (M R)' K^-1 M R.
void NestedResponse::balance(const ByRow& P, const RigidFields& rigid) {
  std::vector<int> inertia(static_cast<std::size_t>(rigid.M_R.cols()));
  std::iota(inertia.begin(), inertia.end(), static_cast<int>(P.rows()));
  const MatrixXd to_inertia = plain<double>(inertia);
  P_R_ = P * rigid.R;
  drift_ = to_inertia.topRows(P.rows()) - P_R_ * to_inertia.bottomRows(rigid.M_R.cols());
}

// Loads that the same parts feel come together: they are ordered by the first part that feels them.
void NestedResponse::group(std::vector<int> loads) {
  std::vector<int> first(static_cast<std::size_t>(n_rows_), -1);
  const auto find_first = [&](const auto& contributions) {
    for (int i = static_cast<int>(contributions.size()) - 1; i >= 0; --i)
      for (int row : contributions[i].row) first[row] = i;
  };
  std::visit(find_first, contributions_);
  std::stable_sort(loads.begin(), loads.end(), [&](int a, int b) { return first[a] < first[b]; });
  for (std::size_t begin = 0; begin < loads.size(); begin += kGroup)
    groups_.emplace_back(loads.begin() + static_cast<std::ptrdiff_t>(begin),
                         loads.begin() + static_cast<std::ptrdiff_t>(std::min(begin + kGroup, loads.size())));
}

template <class T>
Dense<T> NestedResponse::plain(const std::vector<int>& loads) const {
  Dense<T> all = Dense<T>::Zero(n_rows_, static_cast<Index>(loads.size()));
  for (const Contribution<T>& c : std::get<Contributions<T>>(contributions_)) add_responses(c, loads, all);
  return all;
}

MatrixXf NestedResponse::balanced(const std::vector<int>& loads) const {
  const MatrixXd all = plain<double>(loads), P_R_load = P_R_(loads, Eigen::all);
  const Index n = P_R_.rows();
  return (all.topRows(n) - P_R_ * all.bottomRows(n_rows_ - n) - drift_ * P_R_load.transpose()).cast<float>();
}

MatrixXf NestedResponse::next() {
  const std::vector<int>& loads = groups_.at(next_++);
  MatrixXf Y = P_R_.size() > 0 ? balanced(loads)
               : std::holds_alternative<Contributions<float>>(contributions_)
                   ? plain<float>(loads)
                   : MatrixXf(plain<double>(loads).cast<float>());
  std::vector<char> done(static_cast<std::size_t>(n_rows_), 0);
  for (int load : loads) done[load] = 1;
  std::visit(
      [&](auto& contributions) {
        for (auto& c : contributions) remove_rows(done, c);
      },
      contributions_);
  return Y;
}

}  // namespace elastogear::reduction
