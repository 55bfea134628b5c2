#include "reduction/static_response/independent_rows.h"

#include <Eigen/SVD>
#include <map>

namespace elastogear::reduction {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr double kIndependent = 1e-10;  // of the largest singular value, far above roundoff

// The six rows of a node over the columns in which they have entries.
MatrixXd dense(const model::SparseRows& S, int node, std::vector<int>& column) {
  std::map<int, Index> at;
  for (int row = 6 * node; row < 6 * (node + 1); ++row)
    for (model::SparseRows::InnerIterator it(S, row); it; ++it) at.emplace(static_cast<int>(it.col()), 0);
  for (auto& [name, place] : at) {
    place = static_cast<Index>(column.size());
    column.push_back(name);
  }
  MatrixXd rows = MatrixXd::Zero(6, static_cast<Index>(column.size()));
  for (int c = 0; c < 6; ++c)
    for (model::SparseRows::InnerIterator it(S, 6 * node + c); it; ++it)
      rows(c, at.at(static_cast<int>(it.col()))) += it.value();
  return rows;
}

}  // namespace

IndependentRows independent_rows(const model::SparseRows& S) {
  IndependentRows result;
  std::vector<Eigen::Triplet<double>> entries;
  MatrixXd Q(6, S.rows());
  int n = 0;
  for (int node = 0; node < S.rows() / 6; ++node) {
    std::vector<int> column;
    const MatrixXd rows = dense(S, node, column);
    if (!column.empty()) {
      const Eigen::JacobiSVD<MatrixXd> svd(rows, Eigen::ComputeThinU);
      const Eigen::VectorXd& size = svd.singularValues();
      const auto rank = static_cast<int>((size.array() > kIndependent * size[0]).count());
      const MatrixXd W = svd.matrixU().leftCols(rank).transpose() * rows;
      Q.middleCols(n, rank) = svd.matrixU().leftCols(rank);
      for (int i = 0; i < rank; ++i)
        for (Index j = 0; j < W.cols(); ++j)
          entries.emplace_back(n + i, column[static_cast<std::size_t>(j)], W(i, j));
      n += rank;
    }
    result.first.push_back(n);
  }
  result.Q = Q.leftCols(n);
  result.W.resize(n, S.cols());
  result.W.setFromTriplets(entries.begin(), entries.end());
  return result;
}

}  // namespace elastogear::reduction
