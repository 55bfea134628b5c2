#include "reduction/nested/front.h"

#include "reduction/dense/dense_blas.h"

namespace elastogear::reduction {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

// Rows that follow each other, from and to.
struct Run {
  Index from, to, n;
};

std::vector<Run> runs_of(const std::vector<int>& to, std::size_t first, int offset) {
  std::vector<Run> runs;
  for (std::size_t i = first; i < to.size(); ++i)
    if (i > first && to[i] == to[i - 1] + 1)
      ++runs.back().n;
    else
      runs.push_back({static_cast<Index>(i), to[i] - offset, 1});
  return runs;
}

// Adds rows of a column from row `first` of it on.
void add_column(const double* from, const std::vector<Run>& runs, Index first, double* to) {
  for (const Run& run : runs) {
    const Index skipped = std::max<Index>(0, first - run.from);
    for (Index i = skipped; i < run.n; ++i) to[run.to + i] += from[run.from + i];
  }
}

}  // namespace

Front::Front(Index n_inner, Index n_border, Index n_wanted)
    : S_II(MatrixXd::Zero(n_inner, n_inner)),
      S_BI(MatrixXd::Zero(n_border, n_inner)),
      S_BB(MatrixXd::Zero(n_border, n_border)),
      E_I(MatrixXd::Zero(n_wanted, n_inner)),
      E_B(MatrixXd::Zero(n_wanted, n_border)) {}

void add_child(const Condensed& child, const std::vector<int>& place, const std::vector<int>& row,
               Front& front) {
  const auto n_inner = static_cast<int>(front.n_inner());
  std::size_t n_in = 0;
  while (n_in < place.size() && place[n_in] < n_inner) ++n_in;
  const std::vector<Run> inner = runs_of({place.begin(), place.begin() + static_cast<std::ptrdiff_t>(n_in)},
                                         0, 0),
                         border = runs_of(place, n_in, n_inner), wanted = runs_of(row, 0, 0);
  for (std::size_t k = 0; k < place.size(); ++k) {
    const auto j = static_cast<Index>(k);
    const double *const S = child.S.col(j).data(), *const E = child.E.col(j).data();
    if (k < n_in) {
      add_column(S, inner, j, front.S_II.col(place[k]).data());
      add_column(S, border, j, front.S_BI.col(place[k]).data());
      add_column(E, wanted, 0, front.E_I.col(place[k]).data());
    } else {
      add_column(S, border, j, front.S_BB.col(place[k] - n_inner).data());
      add_column(E, wanted, 0, front.E_B.col(place[k] - n_inner).data());
    }
  }
}

void eliminate_inner(const MatrixXd& V, Front& front) {
  if (V.size() == 0) {
    solve_lower_transposed_right(front.S_II, front.S_BI);
    solve_lower_transposed_right(front.S_II, front.E_I);
  } else {
    MatrixXd W = V;
    solve_lower_transposed(front.S_II, W);
    const auto times_W = [&W](MatrixXd& A) {
      MatrixXd product(A.rows(), W.cols());
      multiply(Op::plain, Op::plain, 1, A, W, 0, product);
      A = std::move(product);
    };
    times_W(front.S_BI);
    times_W(front.E_I);
  }
  subtract_square(front.S_BI, front.S_BB);
  multiply(Op::plain, Op::transposed, -1, front.E_I, front.S_BI, 1, front.E_B);
}

}  // namespace elastogear::reduction
