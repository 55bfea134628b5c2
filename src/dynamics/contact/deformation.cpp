#include "elastogear/dynamics/deformation.h"

#include "elastogear/body/affine.h"

namespace elastogear::dynamics {
namespace {

using Eigen::Index;
using model::DenseRows;
using model::SparseRows;

constexpr Index kMostFaces = 100;  // whose edges are watched

struct Edge {
  Index node[2];
  double length;  // m
};

// Two sides of some faces all over the surface.
std::vector<Edge> some_edges(const model::Surface& surface) {
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

// Differences of the edges' ends over their length.
SparseRows edge_operator(const std::vector<Edge>& edges, Index n_rows) {
  SparseRows difference(3 * static_cast<Index>(edges.size()), n_rows);
  std::vector<Eigen::Triplet<double>> entries;
  for (Index row = 0; const Edge& edge : edges)
    for (int d : {0, 1, 2}) {
      entries.emplace_back(row, 3 * edge.node[0] + d, 1 / edge.length);
      entries.emplace_back(row++, 3 * edge.node[1] + d, -1 / edge.length);
    }
  difference.setFromTriplets(entries.begin(), entries.end());
  return difference;
}

void append(const DenseRows& part, DenseRows& all) {
  all.conservativeResize(all.rows() + part.rows(), part.cols());
  all.bottomRows(part.rows()) = part;
}

void append(const SparseRows& part, SparseRows& all) {
  SparseRows both(all.rows() + part.rows(), part.cols());
  both.topRows(all.rows()) = all;
  both.bottomRows(part.rows()) = part;
  all = std::move(both);
}

template <class Rows>
Rows rotation_rows(const model::Marker& marker) {
  return std::visit(
      [](const auto& Phi) -> Rows {
        return Rows(DenseRows(Phi)(Eigen::seqN(3, 3), Eigen::all).sparseView());
      },
      marker.Phi);
}

template <class Rows>
std::unique_ptr<const model::BasisRows> watched(const model::ElasticBody& body) {
  Rows all(0, body.n_q());
  const auto* Phi = std::get_if<Rows>(&body.surface.Phi);
  const bool has_surface = Phi && Phi->rows() > 0 && body.surface.face.cols() > 0;
  if (has_surface) append(Rows(edge_operator(some_edges(body.surface), Phi->rows()) * *Phi), all);
  for (const model::Marker& marker : body.markers) append(rotation_rows<Rows>(marker), all);
  const bool cheap = std::is_same_v<Rows, DenseRows> || !has_surface;
  if (cheap && body.n_q() > 0) append(Rows(body::mean_gradient(body.inertia).sparseView()), all);
  return std::make_unique<const model::BasisRows>(std::move(all));
}

}  // namespace

DeformationWatch::DeformationWatch(const model::ElasticBody& body)
    : rows_(body.basis == model::Basis::full ? watched<SparseRows>(body) : watched<DenseRows>(body)),
      bound_(contact::deformation_bound(*rows_, body.K_r)) {}

double DeformationWatch::largest(const Eigen::VectorXd& q, double limit) const {
  const double bound = contact::largest_displacement(bound_, q);
  return bound > limit ? contact::largest_displacement({rows_.get(), {}, 0}, q) : bound;
}

}  // namespace elastogear::dynamics
