#include "elastogear/body/rigid.h"

#include <Eigen/Eigenvalues>

#include "elastogear/base/error.h"

namespace elastogear::body {
namespace {

constexpr double kRoundoff = 1e-9;  // relative, of inertias typed by hand

void require_mass_distribution(const Eigen::Matrix3d& J_c) {
  require(J_c.allFinite() && (J_c - J_c.transpose()).norm() <= kRoundoff * J_c.norm(),
          "the inertia must be finite and symmetric");
  const Eigen::Vector3d J = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(J_c).eigenvalues();
  require(J[0] >= -kRoundoff * J[2] && J[0] + J[1] >= (1 - kRoundoff) * J[2], "principal inertias ", J[0],
          ", ", J[1], ", ", J[2], " kg m^2: none may be negative or exceed the sum of the others");
}

void drop_elastic_coordinates(model::ElasticBody& body) {
  body.basis = model::Basis::modal;
  body.floating = false;
  body.inertia.C_l.resize(0, 3);
  body.inertia.C_r.resize(0, 3);
  body.inertia.S_1.resize(9, 0);
  body.inertia.S_2.clear();
  body.frequency.resize(0);
  body.zeta.resize(0);
  body.M_r.resize(0, 0);
  body.K_r.resize(0, 0);
  body.surface.Phi = model::DenseRows(model::row_count(body.surface.Phi), 0);
  body.stress = {};
  body.flexibility = {};
  body.relaxing.clear();
  body.n_attachments = 0;
  for (model::Marker& marker : body.markers) marker.Phi = model::DenseRows(6, 0);
}

}  // namespace

model::ElasticBody rigid_body(double m, const Eigen::Vector3d& c, const Eigen::Matrix3d& J_c) {
  require(std::isfinite(m) && m > 0, "mass ", m, " kg must be positive");
  require(c.allFinite(), "centre of mass (", c.transpose(), ") must be finite");
  require_mass_distribution(J_c);
  model::ElasticBody body;
  body.inertia.m = m;
  body.inertia.c = c;
  body.inertia.J = J_c + m * (c.squaredNorm() * Eigen::Matrix3d::Identity() - c * c.transpose());
  drop_elastic_coordinates(body);
  return body;
}

model::ElasticBody rigid_copy(const model::ElasticBody& body) {
  model::ElasticBody copy = body;
  drop_elastic_coordinates(copy);
  return copy;
}

}  // namespace elastogear::body
