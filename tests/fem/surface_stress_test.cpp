// Stresses recovered on free surfaces: where they are exact, and which nodes get them.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "elastogear/base/error.h"
#include "elastogear/fem/material.h"
#include "elastogear/fem/stress.h"
#include "other_cells.h"

namespace elastogear::surface_stress_test {
namespace {

using mesh::CellType;
using mesh::Mesh;
using model::Element;
using model::RecoveryMethod;
using Regions = std::vector<model::MaterialRegion>;

constexpr double kRoundoff = 1e-9;

std::vector<int> all_nodes(const Mesh& mesh) {
  std::vector<int> nodes;
  for (int i = 0; i < mesh.n_nodes(); ++i) nodes.push_back(i);
  return nodes;
}

std::vector<int> nodes_of(const Mesh& mesh, const std::vector<std::string>& sets) {
  std::set<int> nodes;
  for (const std::string& set : sets)
    nodes.insert(mesh.node_sets.at(set).begin(), mesh.node_sets.at(set).end());
  return {nodes.begin(), nodes.end()};
}

bool is_in(const std::vector<int>& nodes, int node) {
  return std::binary_search(nodes.begin(), nodes.end(), node);
}

// Pure bending about z of a bar along x with curvature kappa: stress E kappa y along x, and nothing else.
Eigen::VectorXd bending(const Mesh& mesh, double kappa) {
  const double nu = test::kSteel.nu;
  Eigen::Matrix3Xd u(3, mesh.n_nodes());
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    const double x = mesh.X(0, i), y = mesh.X(1, i), z = mesh.X(2, i);
    u.col(i) << kappa * x * y, -kappa / 2 * (x * x + nu * (y * y - z * z)), -nu * kappa * y * z;
  }
  return u.reshaped();
}

struct OfCells : testing::TestWithParam<CellType> {};
INSTANTIATE_TEST_SUITE_P(All, OfCells,
                         testing::Values(CellType::hex8, CellType::hex20, CellType::tet4, CellType::tet10,
                                         CellType::wedge6, CellType::wedge15, CellType::pyramid5),
                         [](const auto& info) { return std::string(mesh::name(info.param)); });

TEST_P(OfCells, is_exact_in_bending_on_faces_and_edges) {
  const auto brick = test::brick({4, 3, 3}, {0.9, 0.2, 0.3});
  // Graded, and skew but for the sides.
  const auto graded = test::mapped(brick, [](const Eigen::Vector3d& X) {
    return Eigen::Vector3d(X.x() + 0.1 * X.x() * X.x(), X.y() - 0.1, X.z() + X.z() * X.z());
  });
  const auto mesh = test::cells_of(GetParam(), test::distorted(graded, 0.01));
  std::vector<int> ends = nodes_of(mesh, {"xmin", "xmax"}), sides;
  std::set<int> surface;
  for (const mesh::Face& face : mesh::boundary_faces(mesh)) surface.insert(face.begin(), face.end());
  for (int node : surface)
    if (!is_in(ends, node)) sides.push_back(node);
  ASSERT_GT(sides.size(), 20);
  const double kappa = 1e-3;
  const fem::StressedBody body{
      mesh, test::kSteelBody, Element::incompatible, {RecoveryMethod::surface, ends}};
  const Eigen::MatrixXd sigma = fem::nodal_stress(body, bending(mesh, kappa));
  const double scale = test::kSteel.E * kappa * 0.1;
  for (int node : sides) {
    const Eigen::VectorXd exact = Eigen::VectorXd::Unit(6, 0) * test::kSteel.E * kappa * mesh.X(1, node);
    EXPECT_LT((sigma.col(node) - exact).norm(), kRoundoff * scale) << mesh.X.col(node).transpose();
  }
}

TEST_P(OfCells, equals_the_rows_of_the_operator) {
  const auto mesh = test::cells_of(GetParam(), test::brick({3, 3, 2}, {1, 0.4, 0.3}));
  const Eigen::VectorXd u = Eigen::VectorXd::Random(3 * mesh.n_nodes());
  const fem::StressedBody body{
      mesh, test::kSteelBody, Element::incompatible, {RecoveryMethod::surface, mesh.node_sets.at("xmin")}};
  const Eigen::MatrixXd field = fem::nodal_stress(body, u);
  EXPECT_LT((fem::stress_operator(body, all_nodes(mesh)) * u - field.reshaped()).norm(),
            1e-12 * field.norm());
}

TEST(SurfaceStress, of_an_orthotropic_bar_under_tension_is_force_over_area) {
  const auto mesh = test::distorted(test::brick({4, 3, 3}, {1, 0.2, 0.3}), 0.02);
  const Regions regions{{"", test::kFibre}};
  const double stress = 1e6;
  const fem::Matrix6 H = fem::elasticity_matrix(test::kFibre, Eigen::Vector3d::Zero());
  const Eigen::Vector<double, 6> e =
      H.ldlt().solve(Eigen::Vector<double, 6>(Eigen::VectorXd::Unit(6, 0) * stress));
  Eigen::Matrix3d strain;
  strain << e[0], e[3] / 2, e[5] / 2, e[3] / 2, e[1], e[4] / 2, e[5] / 2, e[4] / 2, e[2];
  const Eigen::VectorXd u = (strain * mesh.X).reshaped();
  for (const auto& [method, loaded] :
       {std::pair{RecoveryMethod::average, std::vector<int>{}},
        std::pair{RecoveryMethod::surface, nodes_of(mesh, {"xmin", "xmax"})}}) {
    const Eigen::MatrixXd sigma =
        fem::nodal_stress({mesh, regions, Element::incompatible, {method, loaded}}, u);
    for (int i = 0; i < mesh.n_nodes(); ++i)
      EXPECT_LT((sigma.col(i) - Eigen::VectorXd::Unit(6, 0) * stress).norm(), kRoundoff * stress);
  }
}

TEST(SurfaceStress, several_displacements_have_the_stresses_of_each) {
  const auto mesh = test::brick({3, 3, 2}, {1, 0.4, 0.3});
  const Eigen::MatrixXd U = Eigen::MatrixXd::Random(3 * mesh.n_nodes(), 3);
  for (RecoveryMethod method : {RecoveryMethod::average, RecoveryMethod::surface}) {
    const fem::StressedBody body{mesh, test::kSteelBody, Element::incompatible, {method, {}}};
    const Eigen::MatrixXd all = fem::NodalStresses(body)(U);
    for (int i = 0; i < 3; ++i)
      EXPECT_LT((all.col(i) - fem::nodal_stress(body, U.col(i)).reshaped()).norm(),
                kRoundoff * all.col(i).norm());
  }
  EXPECT_THROW(fem::NodalStresses({mesh, test::kSteelBody, Element::incompatible})(U.topRows(3)), Error);
}

TEST(SurfaceStress, has_no_traction_and_none_at_all_at_corners) {
  const auto mesh = test::brick({3, 3, 3}, {1, 0.4, 0.3});
  const Eigen::VectorXd u = Eigen::VectorXd::Random(3 * mesh.n_nodes());
  const fem::StressedBody body{mesh, test::kSteelBody, Element::incompatible, {RecoveryMethod::surface, {}}};
  const Eigen::MatrixXd sigma = fem::nodal_stress(body, u);
  const double scale = sigma.norm();
  const std::map<std::string, std::array<int, 3>> traction{{"xmin", {0, 3, 5}}, {"xmax", {0, 3, 5}},
                                                           {"ymin", {3, 1, 4}}, {"ymax", {3, 1, 4}},
                                                           {"zmin", {5, 4, 2}}, {"zmax", {5, 4, 2}}};
  for (const auto& [set, components] : traction)
    for (int node : mesh.node_sets.at(set))
      for (int k : components) EXPECT_LT(std::abs(sigma(k, node)), kRoundoff * scale) << set;
  EXPECT_LT(sigma.col(0).norm(), kRoundoff * scale);
}

// Any stress that is the same everywhere is told alike by both recoveries, whatever its traction, and any
// other makes a difference without traction.
TEST(DifferenceWithinSurface, sees_no_even_stress_and_has_no_traction) {
  const auto mesh = test::brick({4, 3, 3}, {1, 0.4, 0.3});
  const std::vector<int> loaded = mesh.node_sets.at("ymax"), all = all_nodes(mesh);
  const fem::StressedBody body{
      mesh, test::kSteelBody, Element::incompatible, {RecoveryMethod::surface, loaded}};
  const model::SparseRows within = fem::difference_within_surface(body, all);
  const Eigen::Matrix3d gradient = Eigen::Matrix3d::Random();
  const Eigen::VectorXd even = (gradient * mesh.X).reshaped(), uneven = Eigen::VectorXd::Random(even.size());
  const double scale = fem::nodal_stress(body, even).norm();
  EXPECT_GT(
      (fem::recovery_difference({mesh, test::kSteelBody, Element::incompatible, {}}, all) * even).norm(),
      0.1 * scale);
  EXPECT_LT((within * even).norm(), kRoundoff * scale);
  const Eigen::VectorXd stress = within * uneven;
  int n_inside = 0;
  for (int node = 0; node < mesh.n_nodes(); ++node) {
    const Eigen::VectorXd at_node = stress.segment<6>(6 * node);
    if (!is_in(loaded, node)) {
      EXPECT_EQ(at_node.norm(), 0) << node;
      continue;
    }
    for (int k : {3, 1, 4}) EXPECT_LT(std::abs(at_node[k]), kRoundoff * stress.norm()) << node;
    n_inside += at_node.norm() > 1e-3 * stress.norm();
  }
  EXPECT_GE(n_inside, 6);
}

// The nodes of a block whose recovered stress differs from the mean of their cells, under random
// displacements.
std::vector<int> recovered(const fem::StressedBody& body) {
  const Eigen::VectorXd u = Eigen::VectorXd::Random(3 * body.mesh.n_nodes());
  const Eigen::MatrixXd found = fem::nodal_stress(body, u),
                        mean = fem::nodal_stress({body.mesh, body.regions, body.element}, u);
  std::vector<int> nodes;
  for (int i = 0; i < body.mesh.n_nodes(); ++i)
    if ((found.col(i) - mean.col(i)).norm() > kRoundoff * mean.col(i).norm()) nodes.push_back(i);
  return nodes;
}

TEST(SurfaceStress, is_taken_at_nodes_that_are_neither_loaded_nor_held) {
  const auto mesh = test::brick({3, 3, 3}, {1, 1, 1});
  std::vector<mesh::Directions> held(static_cast<std::size_t>(mesh.n_nodes()), 0);
  for (int node : mesh.node_sets.at("xmin")) held[node] = mesh::kAllDirections;
  for (int node : mesh.node_sets.at("zmin"))
    held[node] = static_cast<mesh::Directions>(held[node] | 4);  // a plane of symmetry
  for (int node : mesh.node_sets.at("ymax"))
    if (mesh.X(0, node) > 0.9) held[node] = static_cast<mesh::Directions>(held[node] | 2);  // along a line
  const std::vector<int> loaded = mesh.node_sets.at("ymin");
  std::vector<int> expected;
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    const Eigen::Vector3d X = mesh.X.col(i);
    const bool free_face = X.x() > 0.9 || X.y() > 0.9 || X.z() > 0.9, line = X.x() > 0.9 && X.y() > 0.9;
    if (free_face && X.x() > 0.1 && X.y() > 0.1 && !line) expected.push_back(i);
  }
  EXPECT_EQ(
      recovered({mesh, test::kSteelBody, Element::incompatible, {RecoveryMethod::surface, loaded}, held}),
      expected);
}

TEST(SurfaceStress, is_taken_on_the_sides_of_a_plate_of_one_cell_in_plane_strain) {
  const auto mesh = test::brick({4, 3, 1}, {4, 3, 1});
  std::vector<mesh::Directions> held(static_cast<std::size_t>(mesh.n_nodes()), 4);
  for (int node : mesh.node_sets.at("xmin")) held[node] = mesh::kAllDirections;
  std::vector<int> expected;
  for (int i = 0; i < mesh.n_nodes(); ++i)
    if (const Eigen::Vector3d X = mesh.X.col(i); X.x() > 0 && (X.x() == 4 || X.y() == 0 || X.y() == 3))
      expected.push_back(i);
  EXPECT_EQ(recovered({mesh, test::kSteelBody, Element::incompatible, {RecoveryMethod::surface, {}}, held}),
            expected);
}

TEST(SurfaceStress, is_not_taken_at_interfaces_and_reentrant_edges) {
  auto block = test::brick({4, 4, 2}, {4, 4, 2});
  const auto mesh = test::rebuilt(block, [&](Mesh& result, std::span<const int> hex, int) {
    const Eigen::Vector3d X = (block.X.col(hex[0]) + block.X.col(hex[6])) / 2;
    if (X.x() > 2 && X.y() > 2) return;  // an L
    if (X.y() < 1) result.cell_sets["base"].push_back(result.cells.size());
    result.cells.add(CellType::hex8, hex);
  });
  const Regions regions{{"", test::kSteel}, {"base", {70e9, 0.3, 2700}}};
  const auto nodes = recovered({mesh, regions, Element::incompatible, {RecoveryMethod::surface, {}}});
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    const Eigen::Vector3d X = mesh.X.col(i);
    const bool in_L = !(X.x() > 2 && X.y() > 2);
    const bool reentrant = X.x() == 2 && X.y() == 2, between = X.y() == 1;
    const bool outside = X.x() == 0 || X.y() == 0 || X.x() == 4 || X.y() == 4 || X.z() == 0 || X.z() == 2 ||
                         (X.x() == 2 && X.y() > 2) || (X.y() == 2 && X.x() > 2);
    EXPECT_EQ(is_in(nodes, i), in_L && outside && !reentrant && !between) << X.transpose();
  }
}

TEST(SurfaceStress, does_not_reach_across_an_interface) {
  auto mesh = test::brick({6, 2, 2}, {6, 2, 2});
  for (int cell = 0; cell < mesh.cells.size(); ++cell)
    if (mesh.X(0, mesh.cells[cell][0]) >= 3) mesh.cell_sets["tip"].push_back(cell);
  const Regions regions{{"", test::kSteel}, {"tip", {70e9, 0.3, 2700}}};
  const fem::StressedBody body{mesh, regions, Element::incompatible, {RecoveryMethod::surface, {}}};
  const auto S = fem::stress_operator(body, all_nodes(mesh));
  for (int row = 0; row < S.rows(); ++row)
    for (model::SparseRows::InnerIterator it(S, row); it; ++it) {
      const double x = mesh.X(0, row / 6), y = mesh.X(0, it.col() / 3);
      EXPECT_FALSE(it.value() != 0 && ((x < 3 && y > 3) || (x > 3 && y < 3))) << x << " " << y;
    }
}

}  // namespace
}  // namespace elastogear::surface_stress_test
