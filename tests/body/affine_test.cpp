// The affine part of the deformation: exact for affine fields, and of a mass matrix that stays definite.
#include "elastogear/body/affine.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "elastogear/base/rotation.h"
#include "elastogear/body/deformed_inertia.h"
#include "random_body.h"

namespace elastogear::affine_test {
using body::InertiaLevel;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kRoundoff = 1e-12;

body::Equations equations(std::shared_ptr<const model::ElasticBody> body, InertiaLevel level) {
  return make_equations(std::move(body), {.type = body::JointType::free}, level);
}

body::Motion at(const VectorXd& q) {
  body::Motion m{VectorXd::Zero(6), VectorXd::Zero(6), VectorXd::Zero(6), q, q, q};
  m.q_dot.setZero();
  m.q_ddot.setZero();
  return m;
}

// M(q) of (3.3), from the accelerations.
MatrixXd mass_matrix(const body::Equations& eq, const VectorXd& q) {
  const Eigen::Index n = 6 + eq.n_q();
  MatrixXd M(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    body::Motion m = at(q);
    const VectorXd unit = VectorXd::Unit(n, j);
    m.s_ddot = unit.head<6>();
    m.q_ddot = unit.tail(n - 6);
    const body::Force h = inertia_force(eq, m);
    M.col(j) << h.s, h.q;
  }
  return M;
}

double least_eigenvalue(const MatrixXd& M) {
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(M, Eigen::EigenvaluesOnly).eigenvalues().minCoeff();
}

// Seven points that move by affine fields.
std::shared_ptr<const model::ElasticBody> affine_body(int n_fields) {
  constexpr int kPoints = 7;
  std::srand(3);
  const Eigen::VectorXd mass = 0.5 + 0.3 * Eigen::ArrayXd::Random(kPoints);
  const Eigen::Matrix3Xd X = Eigen::Matrix3Xd::Random(3, kPoints);
  MatrixXd Phi = MatrixXd::Zero(3 * kPoints, n_fields);
  for (int p = 0; p < kPoints; ++p)
    for (int k = 0; k < n_fields; ++k) Phi(3 * p + k / 4, k) = k % 4 == 0 ? 1 : X(k % 4 - 1, p);
  auto body = std::make_shared<model::ElasticBody>(*test::random_body());
  test::set_inertia(mass, X, Phi, *body);
  return body;
}

TEST(AffinePart, of_affine_fields_gives_the_inertia_of_level_full) {
  const auto body = affine_body(12);
  const body::Equations affine = equations(body, InertiaLevel::affine),
                        full = equations(body, InertiaLevel::full);
  const VectorXd q = 0.2 * VectorXd::Random(12);
  const MatrixXd M = mass_matrix(full, q);
  EXPECT_LT((mass_matrix(affine, q) - M).norm(), kRoundoff * M.norm());
  body::Motion m = at(q);
  m.s_dot.setRandom();
  m.q_dot.setRandom();
  EXPECT_LT((quadratic_force(affine, m).q - quadratic_force(full, m).q).norm(), kRoundoff * M.norm());
}

TEST(AffinePart, gives_the_gradient_of_an_affine_field) {
  const auto body = affine_body(12);
  const VectorXd q = VectorXd::Random(12), G = body::mean_gradient(body->inertia) * q;
  for (int a : {0, 1, 2})
    for (int b : {0, 1, 2}) EXPECT_NEAR(G[3 * a + b], q[4 * b + 1 + a], kRoundoff);
}

TEST(AffinePart, keeps_the_mass_matrix_positive_where_first_order_inertia_loses_it) {
  const auto body = test::random_body();
  const body::Equations affine = equations(body, InertiaLevel::affine),
                        linear = equations(body, InertiaLevel::linear);
  double worst = 1, worst_linear = 1;
  for (double size : {0., 0.1, 0.3, 1., 3., 10.}) {
    std::srand(5);
    for (int i = 0; i < 20; ++i) {
      const VectorXd q = size * VectorXd::Random(test::kModes);
      worst = std::min(worst, least_eigenvalue(mass_matrix(affine, q)));
      worst_linear = std::min(worst_linear, least_eigenvalue(mass_matrix(linear, q)));
    }
  }
  EXPECT_GT(worst, -kRoundoff);
  EXPECT_LT(worst_linear, -0.1);
}

TEST(AffinePart, of_a_body_without_extension_leaves_out_what_has_no_mass) {
  auto flat = std::make_shared<model::ElasticBody>(*test::random_body());
  const Eigen::Matrix3Xd X = (Eigen::Matrix3Xd(3, 4) << 0, 1, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0).finished();
  test::set_inertia(VectorXd::Ones(4), X, MatrixXd::Random(12, 4), *flat);
  const body::Equations eq = equations(flat, InertiaLevel::affine);
  EXPECT_TRUE(eq.affine.Y.allFinite());
  EXPECT_GT(least_eigenvalue(mass_matrix(eq, 0.1 * VectorXd::Random(4))), -kRoundoff);
}

}  // namespace
}  // namespace elastogear::affine_test
