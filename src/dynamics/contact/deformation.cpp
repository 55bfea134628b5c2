#include "elastogear/dynamics/deformation.h"

#include <algorithm>
#include <utility>

#include "elastogear/body/affine.h"
#include "elastogear/model/row_bounds.h"

namespace elastogear::dynamics {
namespace {

using Eigen::Index;
using model::DenseRows;
using model::Edge;
using model::SparseRows;

// Differences of the edges' ends over their length.
SparseRows edge_rows(const SparseRows& Phi, const std::vector<Edge>& edges) {
  SparseRows difference(3 * static_cast<Index>(edges.size()), Phi.rows());
  std::vector<Eigen::Triplet<double>> entries;
  for (Index row = 0; const Edge& edge : edges)
    for (int d : {0, 1, 2}) {
      entries.emplace_back(row, 3 * edge.node[0] + d, 1 / edge.length);
      entries.emplace_back(row++, 3 * edge.node[1] + d, -1 / edge.length);
    }
  difference.setFromTriplets(entries.begin(), entries.end());
  return difference * Phi;
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
  return model::with_rows(marker.Phi, [](const auto& Phi) -> Rows {
    return Rows(DenseRows(Phi)(Eigen::seqN(3, 3), Eigen::all).sparseView());
  });
}

bool has_faces(const model::Surface& surface) {
  return model::row_count(surface.Phi) > 0 && surface.face.cols() > 0;
}

// Rows of the markers and of the body as a whole.
template <class Rows>
void append_others(const model::ElasticBody& body, bool with_whole, Rows& all) {
  for (const model::Marker& marker : body.markers) append(rotation_rows<Rows>(marker), all);
  if (with_whole && body.n_q() > 0) append(Rows(body::mean_gradient(body.inertia).sparseView()), all);
}

model::BasisRows watched_of_full(const model::ElasticBody& body) {
  SparseRows all(0, body.n_q());
  const auto* Phi = std::get_if<SparseRows>(&body.surface.Phi);
  const bool has_surface = Phi && has_faces(body.surface);
  if (has_surface) append(edge_rows(*Phi, model::watched_edges(body.surface)), all);
  append_others(body, !has_surface, all);
  return all;
}

model::BasisRows watched_of_reduced(const model::ElasticBody& body, bool with_edges) {
  DenseRows all(0, body.n_q());
  if (with_edges) append(model::edge_rows(body.surface.Phi, model::watched_edges(body.surface)), all);
  append_others(body, true, all);
  return all;
}

model::BasisRows watched(const model::ElasticBody& body) {
  if (body.basis == model::Basis::full) return watched_of_full(body);
  const bool is_known = model::known_bounds(body.surface.Phi) != nullptr,
             is_sparse = std::holds_alternative<SparseRows>(body.surface.Phi);
  return watched_of_reduced(body, has_faces(body.surface) && !is_known && !is_sparse);
}

}  // namespace

DeformationWatch::DeformationWatch(const model::ElasticBody& body)
    : rows_(std::make_unique<const model::BasisRows>(watched(body))),
      bound_(contact::deformation_bound(*rows_, body.K_r)) {
  const model::RowBounds* known = model::known_bounds(body.surface.Phi);
  if (!known || !has_faces(body.surface)) return;
  edges_ = [Phi = body.surface.Phi, edges = model::watched_edges(body.surface)] {
    return model::edge_rows(Phi, edges);
  };
  if (bound_.stiffness.size() > 0)
    bound_.compliance = std::max(bound_.compliance, known->strain);
  else
    read_edges();
}

void DeformationWatch::read_edges() const {
  DenseRows all = std::get<DenseRows>(*rows_);
  append(std::exchange(edges_, nullptr)(), all);
  rows_ = std::make_unique<const model::BasisRows>(std::move(all));
  bound_.Phi = rows_.get();
}

double DeformationWatch::largest(const Eigen::VectorXd& q, double limit) const {
  const double bound = contact::largest_displacement(bound_, q);
  if (!(bound > limit)) return bound;
  if (edges_) read_edges();
  return contact::largest_displacement({rows_.get(), {}, 0}, q);
}

}  // namespace elastogear::dynamics
