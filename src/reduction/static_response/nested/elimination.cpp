#include "reduction/static_response/nested/elimination.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "reduction/dense/dense_blas.h"
#include "reduction/dense/residual.h"
#include "reduction/eigensolver/factorisation.h"
#include "reduction/nested/csr_view.h"
#include "reduction/nested/elimination_tree.h"
#include "reduction/nested/front.h"
#include "reduction/static_response/nested/directions.h"

namespace elastogear::reduction {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using ByColumn = Eigen::SparseMatrix<double>;
using ByRow = model::SparseRows;

constexpr Index kLeafColumns = 128;  // right-hand sides that go through a leaf's factor together
constexpr Index kLoadsOfOrder = 4;   // loads per column of C from which ordering saves time
constexpr Index kLeastOrdered = 32;  // columns of C
constexpr Index kSampleRows = 4;     // rows per column that show the directions

// Time of a flop of products over that of elimination: some columns are left out (docs/performance.md).
template <class T>
constexpr double kTimeOfProduct = sizeof(T) == sizeof(float) ? 0.25 : 0.5;

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

// Flops of the elimination of a part by dense matrices.
double flops_of_elimination(const TreePart& part) {
  const double inner = part.n_rows(), border = static_cast<double>(part.border.size()),
               wanted = static_cast<double>(part.row.size());
  return inner * (inner * inner / 3 + border * (inner + border) + wanted * (inner + 2 * border));
}

template <class T>
class Elimination {
 public:
  explicit Elimination(const EliminationTask& task)
      : K_(task.K),
        P_(task.P),
        tree_(make_tree(task.K, P_, task.largest_leaf, task.kept)),
        is_load_(static_cast<std::size_t>(P_.rows()), 0),
        place_(tree_.at.size(), -1),
        row_place_(is_load_.size(), -1),
        condensed_(tree_.part.size()),
        squared_(Eigen::VectorXd::Zero(P_.rows())) {
    for (int load : task.loads) is_load_[load] = 1;
  }

  Contributions<T> run(const std::function<void(double)>& progress) {
    const bool is_whole = tree_.part.size() == 1;
    double done = 0, all = 0;
    for (const TreePart& part : tree_.part)
      all += flops_of_elimination(part) + (is_whole ? 0 : kTimeOfProduct<T> * flops_of_products(part));
    for (std::size_t i = 0; i < tree_.part.size(); ++i) {
      const TreePart& part = tree_.part[i];
      if (progress) progress(done / all);
      enter(part);
      is_whole ? condense_whole(part, condensed_[i]) : condense(part, condensed_[i]);
      done += flops_of_elimination(part);
    }
    if (progress) progress(done / all);
    return std::move(contributions_);
  }

  // The Schur complement and the wanted responses of the rows that are kept, once run() has eliminated all
  // others.
  KeptRows left(const std::vector<int>& kept) {
    const auto n = static_cast<Index>(kept.size());
    const int first = static_cast<int>(tree_.at.size()) - static_cast<int>(n);
    KeptRows left{MatrixXd::Zero(n, n), MatrixXd::Zero(P_.rows(), n)};
    for (Index j = 0; j < n; ++j) {
      K_.visit_row(kept[static_cast<std::size_t>(j)], [&](int column, double value) {
        if (const int i = tree_.position[column] - first; i >= 0) left.S(i, j) += value;
      });
      for (ByColumn::InnerIterator it(P_, kept[static_cast<std::size_t>(j)]); it; ++it)
        left.E(it.row(), j) += it.value();
    }
    const TreePart& root = tree_.part.back();
    std::vector<int> at;
    for (int i : root.border) at.push_back(i - first);
    left.S(at, at) += MatrixXd(condensed_.back().S.template selfadjointView<Eigen::Lower>());
    left.E(root.row, at) += condensed_.back().E;
    return left;
  }

 private:
  Index count_loads(const TreePart& part) const {
    return std::count_if(part.row.begin(), part.row.end(), [&](int row) { return is_load_[row] != 0; });
  }

  // Flops of the products of wanted rows and loads, and of loads with each other, of which symmetry leaves
  // half.
  double flops_of_products(const TreePart& part) const {
    const auto n_loads = static_cast<double>(count_loads(part));
    return part.n_rows() * n_loads * (2 * static_cast<double>(part.row.size()) - n_loads);
  }

  // Notes where rows of K and P are in the matrices of a part.
  void enter(const TreePart& part) {
    for (int i = part.first; i < part.end; ++i) place_[i] = i - part.first;
    for (std::size_t i = 0; i < part.border.size(); ++i)
      place_[part.border[i]] = part.n_rows() + static_cast<int>(i);
    for (std::size_t i = 0; i < part.row.size(); ++i) row_place_[part.row[i]] = static_cast<int>(i);
  }

  // Calls f(place of the column, value) for entries of K in a row of the part that are in the part or its
  // border.
  template <class F>
  void visit(const TreePart& part, int i, F&& f) const {
    K_.visit_row(tree_.at[i], [&](int column, double value) {
      if (const int j = tree_.position[column]; j >= part.first) f(place_[j], value);
    });
  }

  Front make_front(const TreePart& part) const {
    const int n_inner = part.n_rows();
    Front front(n_inner, static_cast<Index>(part.border.size()), static_cast<Index>(part.row.size()));
    for (int i = part.first; i < part.end; ++i) {
      const int j = i - part.first;
      visit(part, i, [&](int place, double value) {
        if (place >= n_inner)
          front.S_BI(place - n_inner, j) += value;
        else if (place >= j)
          front.S_II(place, j) += value;
      });
      for (ByColumn::InnerIterator it(P_, tree_.at[i]); it; ++it)
        front.E_I(row_place_[it.row()], j) += it.value();
    }
    return front;
  }

  void add(int child, Front& front) {
    if (child < 0) return;
    std::vector<int> place, row;
    for (int i : tree_.part[child].border) place.push_back(place_[i]);
    for (int i : tree_.part[child].row) row.push_back(row_place_[i]);
    add_child(std::exchange(condensed_[child], {}), place, row, front);
  }

  // Eq. (6.20a), with columns of C in the order of Eq. (6.20c) where so many rows are loads that it saves
  // time.
  void condense(const TreePart& part, Condensed& result) {
    Front front = make_front(part);
    add(part.left, front);
    add(part.right, front);
    if (!cholesky(front.S_II)) fail_singular("a part of it is not positive definite");
    const bool is_ordered =
        front.n_inner() > kLeastOrdered && count_loads(part) >= kLoadsOfOrder * front.n_inner();
    eliminate_inner(is_ordered ? order(part, front) : MatrixXd(), front);
    result = {std::move(front.S_BB), std::move(front.E_B)};
    if (part.row.empty()) return;
    squared_(part.row) += front.E_I.rowwise().squaredNorm();
    contributions_.push_back({.row = part.row, .C = front.E_I.template cast<T>(), .is_ordered = is_ordered});
  }

  // Directions by rows of C at regular distances, over the roots of what they have of their own responses so
  // far.
  MatrixXd order(const TreePart& part, const Front& front) const {
    const Index n = front.n_inner(), n_rows = front.E_I.rows(),
                every = (n_rows + kSampleRows * n - 1) / (kSampleRows * n);
    std::vector<Index> sampled;
    for (Index i = 0; i < n_rows; i += every) sampled.push_back(i);
    MatrixXd C = front.E_I(sampled, Eigen::all);
    solve_lower_transposed_right(front.S_II, C);
    for (Index i = 0; i < C.rows(); ++i) {
      const int row = part.row[static_cast<std::size_t>(sampled[static_cast<std::size_t>(i)])];
      const double squared = squared_[row] + C.row(i).squaredNorm();
      if (squared > 0) C.row(i) /= std::sqrt(squared);
    }
    MatrixXd gram = MatrixXd::Zero(n, n);
    subtract_square(C.transpose(), gram);
    return directions(-gram);
  }

  // Entries of K and P in the rows that are eliminated, where these are one part.
  struct Whole {
    OwnedMat K_II;
    ByRow K_BI, P_I, P_load;
  };

  Whole entries(const TreePart& part, const std::vector<int>& load) const {
    using Triplets = std::vector<Eigen::Triplet<double>>;
    std::vector<int> load_place(is_load_.size(), -1);
    for (std::size_t i = 0; i < load.size(); ++i) load_place[load[i]] = static_cast<int>(i);
    const int n_inner = part.n_rows();
    Whole whole;
    Triplets border, wanted, loaded;
    for (int i = part.first; i < part.end; ++i) {
      visit(part, i, [&](int place, double value) {
        if (place >= n_inner) {
          border.emplace_back(place - n_inner, i, value);
        } else {
          whole.K_II.column.push_back(place);
          whole.K_II.value.push_back(value);
        }
      });
      whole.K_II.offset.push_back(static_cast<PetscInt>(whole.K_II.column.size()));
      for (ByColumn::InnerIterator it(P_, tree_.at[i]); it; ++it) {
        wanted.emplace_back(row_place_[it.row()], i, it.value());
        if (load_place[it.row()] >= 0) loaded.emplace_back(load_place[it.row()], i, it.value());
      }
    }
    whole.K_II.finish();
    const auto by_row = [n_inner](std::size_t n, const Triplets& values) {
      ByRow rows(static_cast<Index>(n), n_inner);
      rows.setFromTriplets(values.begin(), values.end());
      return rows;
    };
    whole.K_BI = by_row(part.border.size(), border);
    whole.P_I = by_row(part.row.size(), wanted);
    whole.P_load = by_row(load.size(), loaded);
    return whole;
  }

  // All rows that are eliminated as one part, by a sparse factor and a solution for each load.
  void condense_whole(const TreePart& part, Condensed& result) {
    Contribution<T> c{.row = part.row};
    for (int row : part.row)
      if (is_load_[row] != 0) c.load.push_back(row);
    const Whole whole = entries(part, c.load);
    ShiftedFactor factor(whole.K_II.mat, nullptr);
    if (factor.factorise(0) > 0) fail_singular("a pivot is negative");
    const auto for_columns = [&factor](const ByRow& rows, auto&& use) {
      for (Index first = 0; first < rows.rows(); first += kLeafColumns) {
        const Index n = std::min(kLeafColumns, rows.rows() - first);
        MatrixXd X = MatrixXd(rows.middleRows(first, n)).transpose();
        factor.solve(X);
        use(first, n, X);
      }
    };
    const Index n_border = whole.K_BI.rows(), n_wanted = whole.P_I.rows();
    result = {MatrixXd(n_border, n_border), MatrixXd(n_wanted, n_border)};
    for_columns(whole.K_BI, [&](Index first, Index n, const MatrixXd& X) {
      result.S.middleCols(first, n) = -(whole.K_BI * X);
      result.E.middleCols(first, n) = -(whole.P_I * X);
    });
    c.response.resize(n_wanted, whole.P_load.rows());
    for_columns(whole.P_load, [&](Index first, Index n, const MatrixXd& X) {
      c.response.middleCols(first, n) = (whole.P_I * X).template cast<T>();
    });
    if (!c.load.empty()) contributions_.push_back(std::move(c));
  }

  CsrView K_;
  ByColumn P_;
  EliminationTree tree_;
  std::vector<char> is_load_;
  std::vector<int> place_, row_place_;  // of rows of K and P in the matrices of the part at hand
  std::vector<Condensed> condensed_;
  Eigen::VectorXd squared_;  // of each row of P its own response by the parts so far
  Contributions<T> contributions_ = {};
};

}  // namespace

template <class T>
Contributions<T> eliminate(const EliminationTask& task, KeptRows* left,
                           const std::function<void(double)>& progress) {
  Elimination<T> elimination(task);
  Contributions<T> contributions = elimination.run(progress);
  if (left != nullptr) *left = elimination.left(task.kept);
  return contributions;
}

template Contributions<float> eliminate(const EliminationTask&, KeptRows*,
                                        const std::function<void(double)>&);
template Contributions<double> eliminate(const EliminationTask&, KeptRows*,
                                         const std::function<void(double)>&);

}  // namespace elastogear::reduction
