#include "reduction/static_response/nested/contribution.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "reduction/dense/dense_blas.h"

namespace elastogear::reduction {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::MatrixXf;
using Eigen::VectorXd;

// The part of a response that may be left out, over the root of both rows' own responses, Eq. (6.20c): less
// than single precision shows, and in double precision less than shows where responses of free bodies cancel.
template <class T>
constexpr double kNeglected = sizeof(T) == sizeof(float) ? 1e-8 : 1e-14;
constexpr Index kStep = 32;   // columns of C that are kept or left out together
constexpr Index kTile = 512;  // rows and loads of a product

template <class T>
MatrixXf lengths_left_out(const Contribution<T>& c, const VectorXd& scale) {
  const Index n = c.C.cols(), n_steps = (n + kStep - 1) / kStep;
  MatrixXd left = MatrixXd::Zero(c.C.rows(), n_steps + 1);
  for (Index step = n_steps - 1; step >= 0; --step) {
    const Index first = std::max<Index>(0, n - (step + 1) * kStep), width = n - step * kStep - first;
    left.col(step) =
        left.col(step + 1) + c.C.middleCols(first, width).rowwise().squaredNorm().template cast<double>();
  }
  for (Index i = 0; i < left.rows(); ++i) {
    const double size = scale[c.row[i]];
    left.row(i) = left.row(i).cwiseSqrt() * (size > 0 ? 1 / size : 0);
  }
  return left.cast<float>();
}

// The least number of steps after which what is left out of a product of such rows is negligible.
Index steps_needed(const Eigen::RowVectorXf& a, const Eigen::RowVectorXf& b, double neglected) {
  Index step = 0;
  while (step + 1 < a.size() && double(a[step]) * b[step] > neglected) ++step;
  return step;
}

template <class T>
void sort_rows(Contribution<T>& c) {
  std::vector<Index> needed(c.row.size()), order(c.row.size());
  for (std::size_t i = 0; i < c.row.size(); ++i) {
    const Eigen::RowVectorXf own = c.left_out.row(static_cast<Index>(i));
    needed[i] = steps_needed(own, own, kNeglected<T>);
  }
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return needed[a] < needed[b]; });
  std::vector<int> row;
  for (Index i : order) row.push_back(c.row[i]);
  c.row = std::move(row);
  c.C = Dense<T>(c.C(order, Eigen::all));
  c.left_out = MatrixXf(c.left_out(order, Eigen::all));
}

// Rows of a contribution and columns of Y that belong together, by rows.
using Columns = std::vector<std::pair<Index, Index>>;

Columns columns_of(const std::vector<int>& rows, const std::vector<int>& column) {
  Columns columns;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (column[rows[i]] >= 0) columns.emplace_back(static_cast<Index>(i), column[rows[i]]);
  return columns;
}

template <class Block, class T>
void scatter(const Block& part, const int* row, T* column) {
  for (Index i = 0; i < part.size(); ++i) column[row[i]] += part[i];
}

// The products of all rows with the loads columns[first..first + n).
template <class T>
void add_products(const Contribution<T>& c, const Columns& columns, Index first, Index n, Dense<T>& Y) {
  Dense<T> C_load(n, c.C.cols()), part;
  Eigen::RowVectorXf load_left_out = Eigen::RowVectorXf::Zero(c.left_out.cols());
  for (Index j = 0; j < n; ++j) {
    C_load.row(j) = c.C.row(columns[first + j].first);
    if (c.left_out.size() > 0)
      load_left_out = load_left_out.cwiseMax(c.left_out.row(columns[first + j].first));
  }
  for (Index i = 0; i < c.C.rows(); i += kTile) {
    const Index n_i = std::min(kTile, c.C.rows() - i);
    Index k = c.C.cols();
    if (c.left_out.size() > 0)
      k = std::min(k, kStep * steps_needed(c.left_out.middleRows(i, n_i).colwise().maxCoeff(), load_left_out,
                                           kNeglected<T>));
    if (k == 0) continue;
    part.resize(n_i, n);
    multiply(Op::plain, Op::transposed, T(1), c.C.block(i, c.C.cols() - k, n_i, k), C_load.rightCols(k), T(0),
             part);
    for (Index j = 0; j < n; ++j)
      scatter(part.col(j), c.row.data() + i, Y.col(columns[first + j].second).data());
  }
}

}  // namespace

template <class T>
VectorXd row_scales(const Contributions<T>& contributions, int n_rows) {
  VectorXd squared = VectorXd::Zero(n_rows);
  for (const Contribution<T>& c : contributions)
    if (c.C.size() > 0) {
      const VectorXd own = c.C.rowwise().squaredNorm().template cast<double>();
      for (std::size_t i = 0; i < c.row.size(); ++i) squared[c.row[i]] += own[static_cast<Index>(i)];
    }
  return squared.cwiseSqrt();
}

template <class T>
void order_rows(const VectorXd& scale, Contribution<T>& c) {
  c.left_out = lengths_left_out(c, scale);
  sort_rows(c);
}

template <class T>
void add_responses(const Contribution<T>& c, const std::vector<int>& column, Dense<T>& Y) {
  const bool leaf = !c.load.empty();
  const Columns columns = columns_of(leaf ? c.load : c.row, column);
  if (leaf) {
    for (const auto& [from, to] : columns) scatter(c.response.col(from), c.row.data(), Y.col(to).data());
    return;
  }
  const auto n = static_cast<Index>(columns.size());
  for (Index first = 0; first < n; first += kTile)
    add_products(c, columns, first, std::min(kTile, n - first), Y);
}

template <class T>
void remove_rows(const std::vector<char>& marked, Contribution<T>& c) {
  std::vector<Index> left;
  for (std::size_t i = 0; i < c.row.size(); ++i)
    if (marked[c.row[i]] == 0) left.push_back(static_cast<Index>(i));
  if (left.size() == c.row.size()) return;
  std::vector<int> row;
  for (Index i : left) row.push_back(c.row[i]);
  c.row = std::move(row);
  if (c.response.size() > 0) c.response = Dense<T>(c.response(left, Eigen::all));
  if (c.C.size() > 0) c.C = Dense<T>(c.C(left, Eigen::all));
  if (c.left_out.size() > 0) c.left_out = MatrixXf(c.left_out(left, Eigen::all));
}

void fill_symmetric(const std::vector<std::vector<int>>& groups,
                    const std::function<float*(int load)>& column) {
  constexpr std::size_t kBlock = 64;  // loads whose columns stay in the cache
  for (std::size_t later = 1; later < groups.size(); ++later)
    for (std::size_t earlier = 0; earlier < later; ++earlier)
      for (std::size_t first = 0; first < groups[earlier].size(); first += kBlock) {
        const std::size_t end = std::min(first + kBlock, groups[earlier].size());
        std::vector<const float*> from;
        for (std::size_t i = first; i < end; ++i) from.push_back(column(groups[earlier][i]));
        for (int load : groups[later]) {
          float* const to = column(load);
          for (std::size_t i = first; i < end; ++i) to[groups[earlier][i]] = from[i - first][load];
        }
      }
}

template VectorXd row_scales(const Contributions<float>&, int);
template VectorXd row_scales(const Contributions<double>&, int);
template void order_rows(const VectorXd&, Contribution<float>&);
template void order_rows(const VectorXd&, Contribution<double>&);
template void add_responses(const Contribution<float>&, const std::vector<int>&, Dense<float>&);
template void add_responses(const Contribution<double>&, const std::vector<int>&, Dense<double>&);
template void remove_rows(const std::vector<char>&, Contribution<float>&);
template void remove_rows(const std::vector<char>&, Contribution<double>&);

}  // namespace elastogear::reduction
