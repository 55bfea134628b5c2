// What holds for the element of every cell type, alone and in mixed meshes.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "elastogear/base/rotation.h"
#include "elastogear/fem/element.h"
#include "elastogear/fem/inertia.h"
#include "other_cells.h"

namespace elastogear::elements_test {
namespace {

using mesh::CellType;
using mesh::Mesh;
using model::Element;

constexpr double kRoundoff = 1e-12;
constexpr double kNotZero = 1e-4;  // of the largest eigenvalue
const fem::Lame kMaterial = fem::lame(test::kSteel);
const fem::Elasticity kFibre = fem::elasticity(test::kFibre);

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

Eigen::Vector<double, 6> stress_of(const Eigen::Matrix3d& eps, const fem::Elasticity& material) {
  if (const auto* orthotropy = std::get_if<fem::Orthotropy>(&material)) {
    const Eigen::Vector<double, 6> strain{eps(0, 0),     eps(1, 1),     eps(2, 2),
                                          2 * eps(0, 1), 2 * eps(1, 2), 2 * eps(0, 2)};
    return fem::elasticity_at(*orthotropy, Eigen::Vector3d::Zero()).front() * strain;
  }
  const Eigen::Matrix3d s =
      kMaterial.lambda * eps.trace() * Eigen::Matrix3d::Identity() + 2 * kMaterial.mu * eps;
  return {s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2)};
}

// A linear field needs no forces at inner nodes and has the same stress everywhere.
void expect_patch_test(const Mesh& mesh, Element element, const fem::Elasticity& material = kMaterial) {
  fem::require_positive_jacobians(mesh);
  Eigen::Matrix3d A;
  A << 1, 0.3, -0.2, 0.5, -0.7, 0.1, 0.4, 0.2, 0.6;
  const Eigen::Vector<double, 6> expected = stress_of((A + A.transpose()) / 2, material);
  Eigen::Matrix3Xd force = Eigen::Matrix3Xd::Zero(3, mesh.n_nodes());
  for (int cell = 0; cell < mesh.cells.size(); ++cell) {
    const Eigen::Matrix3Xd X = fem::cell_coordinates(mesh, cell);
    const auto& functions = fem::element_functions(mesh.cells.type[cell]);
    const Eigen::VectorXd u = field(A, X), f = functions.stiffness(X, material, element) * u;
    const Eigen::VectorXd sigma = functions.stress(X, material, element) * u;
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

TEST_P(Elements, pass_the_patch_test_with_an_orthotropic_material) {
  expect_patch_test(patch, GetParam().element, kFibre);
}

TEST_P(Elements, find_an_isotropic_material_written_as_an_orthotropic_one_the_same) {
  const double E = test::kSteel.E, nu = test::kSteel.nu, rho = test::kSteel.rho;
  const auto all = [](double value) { return Eigen::Vector3d::Constant(value); };
  model::Material same{0, 0, rho, model::Orthotropic{all(E), all(nu), all(E / (2 * (1 + nu)))}};
  same.orthotropic->orientation.rotation << 0.3, -0.2, 0.5;
  const Eigen::Matrix3Xd X = fem::cell_coordinates(patch, 13);
  const Element element = GetParam().element;
  const Eigen::MatrixXd K = functions.stiffness(X, kMaterial, element),
                        S = functions.stress(X, kMaterial, element);
  EXPECT_LT((functions.stiffness(X, fem::elasticity(same), element) - K).norm(), kRoundoff * K.norm());
  EXPECT_LT((functions.stress(X, fem::elasticity(same), element) - S).norm(), 10 * kRoundoff * S.norm());
}

// K' = Q K Q' with the rotation R of every node in Q.
Eigen::MatrixXd rotated(const Eigen::MatrixXd& K, const Eigen::Matrix3d& R) {
  Eigen::MatrixXd result(K.rows(), K.cols());
  for (Eigen::Index a = 0; a < K.rows(); a += 3)
    for (Eigen::Index b = 0; b < K.cols(); b += 3)
      result.block<3, 3>(a, b) = R * K.block<3, 3>(a, b) * R.transpose();
  return result;
}

TEST_P(Elements, turn_with_a_body_whose_material_turns_with_it) {
  const Eigen::Matrix3Xd X = fem::cell_coordinates(patch, 13);
  const Eigen::Matrix3d R = rotation_matrix({0.7, -0.4, 1.1});
  model::Material turned = test::kFibre;
  model::Orientation& axes = turned.orthotropic->orientation;
  axes.axis_1 = R * axes.axis_1;
  axes.axis_2 = R * axes.axis_2;
  const Eigen::MatrixXd K = rotated(functions.stiffness(X, kFibre, GetParam().element), R);
  EXPECT_LT((functions.stiffness(R * X, fem::elasticity(turned), GetParam().element) - K).norm(),
            kRoundoff * K.norm());
}

TEST_P(Elements, are_the_same_all_around_the_axis_of_a_wound_body) {
  model::Material wound = test::kFibre;
  wound.orthotropic->orientation = {.system = model::Orientation::System::cylindrical,
                                    .origin = {-2, 0.5, 1},
                                    .axis = {0.3, 0.1, 2},
                                    .rotation = {0.6, 0, 0}};
  const fem::Elasticity material = fem::elasticity(wound);
  const model::Orientation& o = wound.orthotropic->orientation;
  const Eigen::Matrix3Xd X = fem::cell_coordinates(patch, 13);
  const Eigen::Matrix3d R = rotation_matrix(1.3 * o.axis.normalized());
  const Eigen::Matrix3Xd around = (R * (X.colwise() - o.origin)).colwise() + o.origin;
  const Eigen::MatrixXd K = rotated(functions.stiffness(X, material, GetParam().element), R);
  EXPECT_LT((functions.stiffness(around, material, GetParam().element) - K).norm(), kRoundoff * K.norm());
  EXPECT_GT((functions.stiffness(R * X, kFibre, GetParam().element) - rotated(stiffness(X), R)).norm(),
            kNotZero * K.norm());
}

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
}  // namespace elastogear::elements_test
