#pragma once
// A body of a few points with random shape functions: all its invariants are those of one mass distribution.

#include <Eigen/Core>
#include <memory>

#include "elastogear/model/elastic_body.h"

namespace elastogear::test {

constexpr int kModes = 4;

// The invariants of points (kg, m) that move by Phi q, 3 n_points x n_q; K_r = diag(1, 2, ...).
inline void set_inertia(const Eigen::VectorXd& mass, const Eigen::Matrix3Xd& X, const Eigen::MatrixXd& Phi,
                        model::ElasticBody& body) {
  const Eigen::Index n_q = Phi.cols();
  const auto axis = [&](int a) -> Eigen::MatrixXd { return Phi(Eigen::seqN(a, mass.size(), 3), Eigen::all); };
  model::Inertia& inertia = body.inertia;
  inertia.m = mass.sum();
  inertia.c = X * mass / inertia.m;
  const Eigen::Matrix3d P = X * mass.asDiagonal() * X.transpose();
  inertia.J = P.trace() * Eigen::Matrix3d::Identity() - P;
  inertia.C_l.resize(n_q, 3);
  inertia.S_1.resize(9, n_q);
  for (int a = 0; a < 3; ++a) {
    inertia.C_l.col(a) = axis(a).transpose() * mass;
    for (int b = 0; b < 3; ++b) inertia.S_1.row(3 * a + b) = X.row(a) * mass.asDiagonal() * axis(b);
  }
  inertia.C_r.resize(n_q, 3);
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    inertia.C_r.col(a) = (inertia.S_1.row(3 * b + c) - inertia.S_1.row(3 * c + b)).transpose();
  }
  Eigen::MatrixXd M_r = Eigen::MatrixXd::Zero(n_q, n_q);
  inertia.S_2.clear();
  for (const auto& [a, b] : {std::pair(0, 0), {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}}) {
    const Eigen::MatrixXd S = axis(a).transpose() * mass.asDiagonal() * axis(b);
    inertia.S_2.push_back(model::DenseRows(S));
    if (a == b) M_r += S;
  }
  body.M_r = M_r.sparseView();
  body.K_r =
      Eigen::MatrixXd(Eigen::VectorXd::LinSpaced(n_q, 1, static_cast<double>(n_q)).asDiagonal()).sparseView();
}

inline std::shared_ptr<const model::ElasticBody> random_body() {
  constexpr int kPoints = 7;
  std::srand(1);
  const Eigen::VectorXd mass = 0.5 + 0.3 * Eigen::ArrayXd::Random(kPoints);
  const Eigen::Matrix3Xd X = Eigen::Matrix3Xd::Random(3, kPoints);
  auto body = std::make_shared<model::ElasticBody>();
  set_inertia(mass, X, Eigen::MatrixXd::Random(3 * kPoints, kModes), *body);
  return body;
}

}  // namespace elastogear::test
