#include "dynamics/node_mobility.h"

namespace elastogear::dynamics {

Eigen::VectorXd elastic_mobility(const model::ElasticBody& body) {
  const Eigen::VectorXd flexibility = Eigen::VectorXd(body.M_r.diagonal()).cwiseInverse();
  const Eigen::VectorXd rows = std::visit(
      [&](const auto& Phi) { return Eigen::VectorXd(Phi.cwiseAbs2() * flexibility); }, body.surface.Phi);
  return rows.reshaped(3, rows.size() / 3).colwise().maxCoeff().transpose();
}

Eigen::VectorXd node_masses(const model::ElasticBody& body) {
  constexpr double kLeast = 0.01;  // of the body, which stiff surroundings of a small node are part of
  return (elastic_mobility(body).array() + 1 / body.inertia.m).inverse().cwiseMax(kLeast * body.inertia.m);
}

}  // namespace elastogear::dynamics
