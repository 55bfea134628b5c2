#include "recovery/mode_acceleration.h"

namespace elastogear::recovery {

Eigen::MatrixXd dynamic_part(const model::ElasticBody& body, const Eigen::MatrixXd& q,
                             const model::ForceHistory& forces) {
  Eigen::MatrixXd h = Eigen::MatrixXd::Zero(q.rows(), q.cols());
  for (std::size_t i = 0; i < forces.node.size(); ++i)
    model::with_rows(body.surface.Phi, [&](const auto& Phi) {
      h += Phi.middleRows(3 * forces.node[i], 3).transpose() *
           forces.force.middleRows(3 * static_cast<Eigen::Index>(i), 3);
    });
  return q - body.K_r.diagonal().cwiseInverse().asDiagonal() * h;
}

Eigen::MatrixXd inertial_part(const model::ElasticBody& body, const Eigen::MatrixXd& q_d,
                              const Eigen::Ref<const Eigen::MatrixXd>& w) {
  Eigen::MatrixXd relaxed = Eigen::MatrixXd::Zero(q_d.rows(), q_d.cols());
  for (std::size_t p = 0; p < body.relaxing.size(); ++p)
    relaxed += body.relaxing[p].K * w.middleRows(static_cast<Eigen::Index>(p) * q_d.rows(), q_d.rows());
  return q_d - body.K_r.diagonal().cwiseInverse().asDiagonal() * relaxed;
}

}  // namespace elastogear::recovery
