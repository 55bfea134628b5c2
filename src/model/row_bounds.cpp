#include "elastogear/model/row_bounds.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "elastogear/base/fingerprint.h"
#include "elastogear/model/row_products.h"

namespace elastogear::model {
namespace {

using Eigen::Index;

constexpr Index kMostFaces = 100;    // whose edges are watched
constexpr double kSameBound = 1e-9;  // relative, far above the roundoff of sums of n_q terms
constexpr double kRoundoffOfTrace = 1e-12;

bool is_positive_diagonal(const Eigen::SparseMatrix<double>& A) {
  return A.rows() > 0 && A.nonZeros() == A.rows() && (A.diagonal().array() > 0).all();
}

double largest_eigenvalue(const Eigen::Matrix3d& C) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(C, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
}

struct NodeBounds {
  double compliance, mobility, square;
};

NodeBounds node_bounds(const double* rows, const RowWeights& weights) {
  const Index n_q = weights.compliance.size();
  return {largest_eigenvalue(weighted_squares(rows, weights.compliance.data(), n_q)),
          weighted_squares(rows, weights.mobility.data(), n_q).diagonal().maxCoeff(),
          Eigen::Map<const Eigen::VectorXd>(rows, 3 * n_q).squaredNorm()};
}

bool is_same(double a, double b) {
  return std::abs(a - b) <= kSameBound * std::max(std::abs(a), std::abs(b));
}

}  // namespace

std::vector<Edge> watched_edges(const Surface& surface) {
  std::vector<Edge> edges;
  const Index n_f = surface.face.cols(), stride = std::max<Index>(1, n_f / kMostFaces);
  for (Index f = 0; f < n_f; f += stride)
    for (int i : {0, 1, 2}) {
      const int a = surface.face(i, f), b = surface.face(i + 1, f);
      const double length = (surface.X.col(a) - surface.X.col(b)).norm();
      if (length > 0) edges.push_back({{a, b}, length});
    }
  return edges;
}

DenseRows edge_rows(const BasisRows& Phi, const std::vector<Edge>& edges) {
  DenseRows rows(3 * static_cast<Index>(edges.size()), column_count(Phi));
  for (Index row = 0; const Edge& edge : edges) {
    const auto at = [&](int end) {
      return Eigen::Map<const DenseRows>(node_rows(Phi, edge.node[end]), 3, rows.cols());
    };
    rows.middleRows<3>(row) = (1 / edge.length) * at(0) - (1 / edge.length) * at(1);
    row += 3;
  }
  return rows;
}

// Traces, which are not below the largest eigenvalue, leave out most.
double largest_square(const DenseRows& A, const Eigen::VectorXd& w) {
  double largest = 0;
  for (Index i = 0; i < A.rows(); i += 3) {
    const Eigen::Matrix3d C = weighted_squares(A.row(i).data(), w.data(), A.cols());
    if (C.trace() >= (1 - kRoundoffOfTrace) * largest) largest = std::max(largest, largest_eigenvalue(C));
  }
  return largest;
}

std::optional<RowWeights> row_weights(const ElasticBody& body) {
  if (!is_positive_diagonal(body.K_r) || !is_positive_diagonal(body.M_r)) return std::nullopt;
  return RowWeights{Eigen::VectorXd(body.K_r.diagonal()).cwiseInverse(),
                    Eigen::VectorXd(body.M_r.diagonal()).cwiseInverse()};
}

std::optional<RowBounds> row_bounds(const ElasticBody& body) {
  const DenseRows* Phi = dense_rows(body.surface.Phi);
  const std::optional<RowWeights> weights = row_weights(body);
  if (!Phi || Phi->size() == 0 || !weights) return std::nullopt;
  RowBounds bounds;
  const Index n = Phi->rows() / 3;
  for (Eigen::VectorXd* x : {&bounds.compliance, &bounds.mobility, &bounds.square}) x->resize(n);
  for (Index i = 0; i < n; ++i) {
    const NodeBounds node = node_bounds(Phi->row(3 * i).data(), *weights);
    bounds.compliance[i] = node.compliance;
    bounds.mobility[i] = node.mobility;
    bounds.square[i] = node.square;
  }
  bounds.largest = Phi->cwiseAbs().colwise().maxCoeff().transpose();
  bounds.strain =
      largest_square(edge_rows(body.surface.Phi, watched_edges(body.surface)), weights->compliance);
  bounds.digest = block_digest(Phi->data(), static_cast<std::size_t>(Phi->size()));
  return bounds;
}

bool are_bounds_of(const RowBounds& bounds, const RowWeights& weights, Index first, Index n,
                   const double* rows) {
  for (Index i = 0; i < n; ++i) {
    const NodeBounds node = node_bounds(rows + 3 * i * bounds.largest.size(), weights);
    if (!is_same(node.compliance, bounds.compliance[first + i]) ||
        !is_same(node.mobility, bounds.mobility[first + i]) ||
        !is_same(node.square, bounds.square[first + i]))
      return false;
  }
  return true;
}

}  // namespace elastogear::model
