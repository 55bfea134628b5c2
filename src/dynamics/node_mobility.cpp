#include "dynamics/node_mobility.h"

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

}  // namespace elastogear::dynamics
