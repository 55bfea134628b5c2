#include "recovery/mode_acceleration.h"

#include <Eigen/QR>

namespace elastogear::recovery {
namespace {

// Share below which a combination of marker forces and moments counts as one that attachment modes do not
// distinguish; forces and moments are scaled by the response to each of them.
constexpr double kIndependentLoads = 1e-6;

// Rows of all markers' modes, 6 n_m x n_q.
Eigen::MatrixXd marker_rows(const model::ElasticBody& body) {
  Eigen::MatrixXd Phi(6 * static_cast<Eigen::Index>(body.markers.size()), body.n_q());
  for (std::size_t m = 0; m < body.markers.size(); ++m)
    model::with_rows(body.markers[m].Phi,
                     [&](const auto& rows) { Phi.middleRows(6 * static_cast<Eigen::Index>(m), 6) = rows; });
  return Phi;
}

}  // namespace

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

Eigen::MatrixXd without_marker_loads(const model::ElasticBody& body, const Eigen::MatrixXd& q_d) {
  const Eigen::Index n_a = body.n_attachments;
  if (n_a == 0) return q_d;
  const Eigen::VectorXd omega = body.K_r.diagonal().cwiseSqrt();
  const Eigen::MatrixXd all = marker_rows(body) * omega.cwiseInverse().asDiagonal();
  Eigen::VectorXd size = all.rightCols(n_a).rowwise().norm();
  size = (size.array() > 0).select(size.cwiseInverse(), 0);
  const Eigen::MatrixXd scaled = size.asDiagonal() * all;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> loads;
  loads.setThreshold(kIndependentLoads);
  loads.compute(scaled.rightCols(n_a).transpose());
  const Eigen::MatrixXd w = loads.solve(omega.tail(n_a).asDiagonal() * q_d.bottomRows(n_a));
  return q_d - omega.cwiseInverse().asDiagonal() * (scaled.transpose() * w);
}

Eigen::MatrixXd inertial_part(const model::ElasticBody& body, const Eigen::MatrixXd& q_d,
                              const Eigen::Ref<const Eigen::MatrixXd>& w) {
  Eigen::MatrixXd relaxed = Eigen::MatrixXd::Zero(q_d.rows(), q_d.cols());
  for (std::size_t p = 0; p < body.relaxing.size(); ++p)
    relaxed += body.relaxing[p].K * w.middleRows(static_cast<Eigen::Index>(p) * q_d.rows(), q_d.rows());
  return q_d - body.K_r.diagonal().cwiseInverse().asDiagonal() * relaxed;
}

}  // namespace elastogear::recovery
