#include "dynamics/contact/node_mobility.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "dynamics/contact/residual_flexibility.h"
#include "elastogear/model/row_products.h"

namespace elastogear::dynamics {

namespace {

// Rows of a node, weighted with the inverse masses: the largest of three sums.
Eigen::VectorXd mobility(const model::DenseRows& Phi, const Eigen::VectorXd& flexibility) {
  Eigen::VectorXd most(Phi.rows() / 3);
  for (Eigen::Index node = 0; node < most.size(); ++node)
    most[node] = model::weighted_squares(Phi.row(3 * node).data(), flexibility.data(), Phi.cols())
                     .diagonal()
                     .maxCoeff();
  return most;
}

Eigen::VectorXd mobility(const model::SparseRows& Phi, const Eigen::VectorXd& flexibility) {
  const Eigen::VectorXd rows = Phi.cwiseAbs2() * flexibility;
  return rows.reshaped(3, rows.size() / 3).colwise().maxCoeff().transpose();
}

// Corners of a face, ascending; a triangle repeats its third one.
std::vector<int> corners(const model::Surface& surface, Eigen::Index f) {
  std::vector<int> nodes(surface.face.col(f).begin(), surface.face.col(f).end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

// Share of the compliance of a cell, 1 / (c_f A), that modes leave out where an even pressure acts on the
// face of the cell. Eq. (6.24b).
double share_left(const model::Surface& surface, Eigen::Index f, ResidualFlexibility& residual) {
  const std::vector<int> nodes = corners(surface, f);
  const auto x = [&](int corner) -> Eigen::Vector3d { return surface.X.col(surface.face(corner, f)); };
  const Eigen::Vector3d a = 0.5 * (x(2) - x(0)).cross(x(3) - x(1)),
                        triangle = 0.5 * (x(1) - x(0)).cross(x(2) - x(0));
  const Eigen::Vector3d area = nodes.size() == 3 ? triangle : a;
  const Eigen::VectorXd even = area.normalized().replicate(static_cast<Eigen::Index>(nodes.size()), 1) /
                               static_cast<double>(nodes.size());
  return even.dot(residual.among(nodes) * even) * surface.c_f[f] * area.norm();
}

}  // namespace

Eigen::VectorXd elastic_mobility(const model::ElasticBody& body) {
  const Eigen::VectorXd flexibility = Eigen::VectorXd(body.M_r.diagonal()).cwiseInverse();
  if (const model::RowBounds* bounds = model::known_bounds(body.surface.Phi)) return bounds->mobility;
  return model::with_rows(body.surface.Phi, [&](const auto& Phi) { return mobility(Phi, flexibility); });
}

Eigen::VectorXd node_masses(const model::ElasticBody& body) {
  constexpr double kLeast = 0.01;  // of the body, which stiff surroundings of a small node are part of
  return (elastic_mobility(body).array() + 1 / body.inertia.m).inverse().cwiseMax(kLeast * body.inertia.m);
}

std::vector<bool> responding_nodes(const model::ElasticBody& body) {
  constexpr double kLeastShare = 0.5;
  const model::Surface& surface = body.surface;
  std::vector<bool> result(static_cast<std::size_t>(surface.X.cols()));
  for (std::size_t node = 0; node < result.size(); ++node)
    result[node] = model::find_loaded(body.flexibility, static_cast<int>(node)) >= 0;
  if (body.flexibility.empty() || body.n_q() < surface.X.cols()) return result;
  ResidualFlexibility residual(body);
  std::vector<bool> compliant(result.size());
  for (Eigen::Index f = 0; f < surface.face.cols(); ++f)
    if (share_left(surface, f, residual) > kLeastShare)
      for (int node : surface.face.col(f)) compliant[static_cast<std::size_t>(node)] = true;
  for (std::size_t node = 0; node < result.size(); ++node) result[node] = result[node] && compliant[node];
  return result;
}

}  // namespace elastogear::dynamics
