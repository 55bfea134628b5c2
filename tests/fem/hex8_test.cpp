#include "fem/elements/hex8.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "brick.h"
#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"
#include "elastogear/fem/element.h"

namespace elastogear::hex8_test {
namespace {

using fem::hex8::Coordinates;
using model::Element;

constexpr double kRoundoff = 1e-12;
const fem::Lame kMaterial = fem::lame(test::kSteel);

Coordinates skewed_cell() {
  Coordinates X;
  X << 0, 1.1, 1.3, -0.1, 0.2, 1.0, 1.2, 0.1,  //
      0, 0.1, 1.2, 0.9, -0.2, 0.1, 0.9, 1.1,   //
      0, -0.1, 0.2, 0.1, 0.8, 1.1, 1.0, 1.3;
  return X;
}

// Displacement field A X + b at the nodes.
Eigen::VectorXd linear_field(const Coordinates& X, const Eigen::Matrix3d& A, const Eigen::Vector3d& b) {
  const Coordinates u = (A * X).colwise() + b;
  return u.reshaped();
}

class Stiffness : public testing::TestWithParam<Element> {};

TEST_P(Stiffness, annihilates_the_six_rigid_modes_and_nothing_else) {
  const Coordinates X = skewed_cell();
  const auto K = fem::hex8::stiffness(X, kMaterial, GetParam());
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d e = Eigen::Vector3d::Unit(i);
    EXPECT_LT((K * linear_field(X, Eigen::Matrix3d::Zero(), e)).norm(), kRoundoff * K.norm());
    EXPECT_LT((K * linear_field(X, skew(e), Eigen::Vector3d::Zero())).norm(), kRoundoff * K.norm());
  }
  const Eigen::VectorXd lambda = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K).eigenvalues();
  EXPECT_LT(std::abs(lambda(5)), kRoundoff * lambda(23));
  EXPECT_GT(lambda(6), 1e-3 * lambda(23));
}

TEST_P(Stiffness, passes_the_patch_test) {
  // Cells of random shape: a linear field needs no inner forces and has the same stress everywhere.
  const auto mesh = test::distorted(test::brick({3, 3, 3}, {1, 1, 1}), 0.1);
  Eigen::Matrix3d A;
  A << 1, 0.3, -0.2, 0.5, -0.7, 0.1, 0.4, 0.2, 0.6;
  const Eigen::Matrix3d eps = (A + A.transpose()) / 2;
  const Eigen::Matrix3d sigma =
      kMaterial.lambda * eps.trace() * Eigen::Matrix3d::Identity() + 2 * kMaterial.mu * eps;
  Eigen::Matrix<double, 6, 1> expected;
  expected << sigma(0, 0), sigma(1, 1), sigma(2, 2), sigma(0, 1), sigma(1, 2), sigma(0, 2);
  Eigen::Matrix3Xd force = Eigen::Matrix3Xd::Zero(3, mesh.n_nodes());
  for (int cell = 0; cell < mesh.cells.size(); ++cell) {
    const Coordinates X = fem::cell_coordinates(mesh, cell);
    const Eigen::VectorXd u = linear_field(X, A, Eigen::Vector3d::Zero());
    const Eigen::VectorXd f = fem::hex8::stiffness(X, kMaterial, GetParam()) * u;
    const Eigen::VectorXd s = fem::hex8::stress(X, kMaterial, GetParam()) * u;
    for (int a = 0; a < 8; ++a) {
      force.col(mesh.cells[cell][a]) += f.segment<3>(3 * a);
      EXPECT_LT((s.segment<6>(6 * a) - expected).norm(), kRoundoff * expected.norm());
    }
  }
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    const bool inner = (mesh.X.col(i).array() > 1e-9).all() && (mesh.X.col(i).array() < 1 - 1e-9).all();
    if (!inner) continue;
    EXPECT_LT(force.col(i).norm(), kRoundoff * expected.norm());
  }
}

INSTANTIATE_TEST_SUITE_P(Elements, Stiffness,
                         testing::Values(Element::plain, Element::incompatible, Element::bbar));

TEST(IncompatibleModes, bend_a_rectangular_cell_exactly) {
  const auto mesh = test::brick({1, 1, 1}, {4, 1, 1});
  const Coordinates X = fem::cell_coordinates(mesh, 0);
  // Bending about y with curvature 1 and its anticlastic part; a plain brick locks in shear instead.
  Eigen::VectorXd u = Eigen::VectorXd::Zero(24);
  for (int a = 0; a < 8; ++a) {
    const Eigen::Vector3d x = X.col(a) - Eigen::Vector3d(2, 0.5, 0.5);
    u.segment<3>(3 * a) << x.x() * x.z(), -test::kSteel.nu * x.y() * x.z(), 0;
  }
  const double exact = test::kSteel.E * 4.0 / 12;  // integral of E z^2 dV
  const double plain = u.dot(fem::hex8::stiffness(X, kMaterial, Element::plain) * u);
  EXPECT_NEAR(u.dot(fem::hex8::stiffness(X, kMaterial, Element::incompatible) * u), exact, kRoundoff * exact);
  EXPECT_GT(plain, 5 * exact);
  // The stress of a beam at the nodes: sigma_xx = E z, nothing else.
  const Eigen::VectorXd s = fem::hex8::stress(X, kMaterial, Element::incompatible) * u;
  for (int a = 0; a < 8; ++a) {
    EXPECT_NEAR(s(6 * a), test::kSteel.E * (X(2, a) - 0.5), kRoundoff * exact);
    EXPECT_LT(s.segment<5>(6 * a + 1).norm(), kRoundoff * exact);
  }
}

TEST(Mass, is_symmetric_positive_and_sums_to_the_mass) {
  const Coordinates X = skewed_cell();
  const fem::hex8::Mass M = fem::hex8::mass(X, 2.0);
  EXPECT_NEAR(M.sum(), 2 * fem::hex8::volume(X), kRoundoff);
  EXPECT_LT((M - M.transpose()).norm(), kRoundoff);
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(M).eigenvalues()(0), 0);
}

TEST(Jacobian, of_an_inverted_cell_is_an_error_naming_cell_and_value) {
  auto mesh = test::brick({2, 1, 1}, {2, 1, 1});
  EXPECT_NO_THROW(fem::require_positive_jacobians(mesh));
  mesh.X.row(2) *= -1;
  try {
    fem::require_positive_jacobians(mesh);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("cell 0"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("-0.125"), std::string::npos) << error.what();
  }
  mesh.X.row(2) *= 0;
  EXPECT_THROW(fem::require_positive_jacobians(mesh), Error);
}

}  // namespace
}  // namespace elastogear::hex8_test
