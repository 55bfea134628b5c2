// What holds for the element of every cell type, alone and in mixed meshes.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "elastogear/base/rotation.h"
#include "elastogear/fem/element.h"
#include "elastogear/fem/inertia.h"
#include "other_cells.h"

namespace {

using namespace elastogear;
using mesh::CellType;
using mesh::Mesh;
using model::Element;

constexpr double kRoundoff = 1e-12;
constexpr double kNotZero = 1e-4;  // of the largest eigenvalue
const fem::Lame kMaterial = fem::lame(test::kSteel);

struct Case {
  CellType type;
  Element element = Element::incompatible;
};

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (CellType type : test::all_cell_types()) cases.push_back({type});
  cases.push_back({CellType::hex8, Element::plain});
  cases.push_back({CellType::hex8, Element::bbar});
  return cases;
}

struct Elements : testing::TestWithParam<Case> {
  Mesh patch = test::cells_of(GetParam().type, test::distorted(test::brick({3, 3, 3}, {1, 1, 1}), 0.05));
  const fem::ElementFunctions& functions = fem::element_functions(GetParam().type);

  Eigen::MatrixXd stiffness(const Eigen::Matrix3Xd& X) const {
    return functions.stiffness(X, kMaterial, GetParam().element);
  }
};
std::string case_name(const testing::TestParamInfo<Case>& info) {
  const char* const names[] = {"", "_plain", "_bbar"};
  return std::string(mesh::name(info.param.type)) + names[static_cast<int>(info.param.element)];
}
INSTANTIATE_TEST_SUITE_P(All, Elements, testing::ValuesIn(all_cases()), case_name);

Eigen::VectorXd field(const Eigen::Matrix3d& A, const Eigen::Matrix3Xd& X) {
  return (A * X).eval().reshaped();
}

// The wedge's two points on its axis do not see its twist about that axis, which its neighbours in a mesh
// resist.
int zero_energy_modes(CellType type) { return type == CellType::wedge6 ? 7 : 6; }

TEST_P(Elements, have_six_rigid_modes_and_no_unknown_mode_of_zero_energy) {
  const int n_zero = zero_energy_modes(GetParam().type);
  for (int cell = 0; cell < patch.cells.size(); cell += 5) {
    const Eigen::Matrix3Xd X = fem::cell_coordinates(patch, cell);
    const Eigen::MatrixXd K = stiffness(X);
    EXPECT_LT((K - K.transpose()).norm(), kRoundoff * K.norm());
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d e = Eigen::Vector3d::Unit(i);
      EXPECT_LT((K * e.replicate(X.cols(), 1)).norm(), kRoundoff * K.norm());
      EXPECT_LT((K * field(skew(e), X)).norm(), kRoundoff * K.norm());
    }
    const Eigen::VectorXd lambda = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K).eigenvalues();
    const double largest = lambda(lambda.size() - 1);
    EXPECT_LT(std::abs(lambda(n_zero - 1)), kRoundoff * largest);
    EXPECT_GT(lambda(n_zero), kNotZero * largest);
  }
}

TEST_P(Elements, have_only_six_modes_of_zero_energy_in_a_mesh) {
  const Mesh mesh = test::cells_of(GetParam().type, test::brick({1, 1, 1}, {1, 1, 1}));
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(3 * mesh.n_nodes(), 3 * mesh.n_nodes());
  for (int cell = 0; cell < mesh.cells.size(); ++cell) {
    const auto nodes = mesh.cells[cell];
    const Eigen::MatrixXd K_e = stiffness(fem::cell_coordinates(mesh, cell));
    for (int a = 0; a < std::ssize(nodes); ++a)
      for (int b = 0; b < std::ssize(nodes); ++b)
        K.block<3, 3>(3 * nodes[a], 3 * nodes[b]) += K_e.block<3, 3>(3 * a, 3 * b);
  }
  const Eigen::VectorXd lambda = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K).eigenvalues();
  const double largest = lambda(lambda.size() - 1);
  EXPECT_LT(std::abs(lambda(5)), kRoundoff * largest);
  EXPECT_GT(lambda(6), kNotZero * largest);
}

// A linear field needs no forces at inner nodes and has the same stress everywhere.
void expect_patch_test(const Mesh& mesh, Element element) {
  fem::require_positive_jacobians(mesh);
  Eigen::Matrix3d A;
  A << 1, 0.3, -0.2, 0.5, -0.7, 0.1, 0.4, 0.2, 0.6;
  const Eigen::Matrix3d eps = (A + A.transpose()) / 2;
  const Eigen::Matrix3d s =
      kMaterial.lambda * eps.trace() * Eigen::Matrix3d::Identity() + 2 * kMaterial.mu * eps;
  const Eigen::Vector<double, 6> expected{s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2)};
  Eigen::Matrix3Xd force = Eigen::Matrix3Xd::Zero(3, mesh.n_nodes());
  for (int cell = 0; cell < mesh.cells.size(); ++cell) {
    const Eigen::Matrix3Xd X = fem::cell_coordinates(mesh, cell);
    const auto& functions = fem::element_functions(mesh.cells.type[cell]);
    const Eigen::VectorXd u = field(A, X), f = functions.stiffness(X, kMaterial, element) * u;
    const Eigen::VectorXd sigma = functions.stress(X, kMaterial, element) * u;
    for (int a = 0; a < X.cols(); ++a) {
      force.col(mesh.cells[cell][a]) += f.segment<3>(3 * a);
      EXPECT_LT((sigma.segment<6>(6 * a) - expected).norm(), 10 * kRoundoff * expected.norm());
    }
  }
  int inner = 0;
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    const bool is_inner = (mesh.X.col(i).array() > 1e-9).all() && (mesh.X.col(i).array() < 1 - 1e-9).all();
    if (!is_inner) continue;
    EXPECT_LT(force.col(i).norm(), kRoundoff * expected.norm());
    ++inner;
  }
  EXPECT_GE(inner, 8);
}

TEST_P(Elements, pass_the_patch_test) { expect_patch_test(patch, GetParam().element); }

TEST(MixedMesh, passes_the_patch_test) {
  const Mesh hexahedra = test::distorted(test::brick({4, 4, 4}, {1, 1, 1}), 0.03);
  for (Element element : {Element::incompatible, Element::plain, Element::bbar}) {
    expect_patch_test(test::mixed(hexahedra, 4), element);
    expect_patch_test(test::second_order(test::hexahedra_and_wedges(hexahedra, 4)), element);
  }
}

TEST_P(Elements, have_the_mass_and_inertia_of_the_body_they_fill) {
  const Mesh box = test::brick({1, 1, 1}, {1, 1, 1});
  const auto exact = fem::rigid_inertia(box, fem::mass_moments(box, test::kSteelBody));
  const auto inertia = fem::rigid_inertia(patch, fem::mass_moments(patch, test::kSteelBody));
  EXPECT_NEAR(inertia.m / exact.m, 1, kRoundoff);
  EXPECT_LT((inertia.c - exact.c).norm(), kRoundoff);
  EXPECT_LT((inertia.J - exact.J).norm(), kRoundoff * exact.J.norm());
}

TEST_P(Elements, have_symmetric_positive_mass_that_sums_to_the_volume) {
  double volume = 0;
  for (int cell = 0; cell < patch.cells.size(); ++cell) {
    const Eigen::Matrix3Xd X = fem::cell_coordinates(patch, cell);
    const Eigen::MatrixXd M = functions.mass(X, 1);
    EXPECT_NEAR(M.sum(), functions.volume(X), kRoundoff);
    EXPECT_LT((M - M.transpose()).norm(), kRoundoff * M.norm());
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(M).eigenvalues()(0), 0);
    volume += functions.volume(X);
  }
  EXPECT_NEAR(volume, 1, kRoundoff);
}

TEST_P(Elements, are_refused_when_turned_inside_out) {
  Mesh mirrored = patch;
  mirrored.X.row(2) *= -1;
  EXPECT_ANY_THROW(fem::require_positive_jacobians(mirrored));
}

TEST(Bbar, resists_a_dilatation_without_mean_only_by_its_shape_change) {
  // u_x = xy: the divergence y has no mean on a centred cube, so that the bulk modulus has no part in the
  // energy.
  const Mesh cube =
      test::mapped(test::brick({1, 1, 1}, {2, 2, 2}),
                   [](const Eigen::Vector3d& X) -> Eigen::Vector3d { return X - Eigen::Vector3d::Ones(); });
  const Eigen::Matrix3Xd X = fem::cell_coordinates(cube, 0);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(24);
  for (int a = 0; a < 8; ++a) u(3 * a) = X(0, a) * X(1, a);
  const auto& functions = fem::element_functions(CellType::hex8);
  const auto energy = [&](double bulk_modulus) {
    const fem::Lame material{bulk_modulus - 2.0 / 3, 1};
    return u.dot(functions.stiffness(X, material, Element::bbar) * u);
  };
  // integral of 2 e:e + gamma_xy^2 over the cube with e = dev diag(y, 0, 0): (4/3 + 1) 8/3
  EXPECT_NEAR(energy(1), 56.0 / 9, kRoundoff);
  EXPECT_NEAR(energy(1e3), 56.0 / 9, 1e3 * kRoundoff);
}

}  // namespace
