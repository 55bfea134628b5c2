#include "elastogear/reduction/marker.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "../fem/brick.h"
#include "../fem/other_cells.h"
#include "elastogear/base/error.h"
#include "elastogear/fem/restraint.h"
#include "reduction/basis.h"

namespace elastogear::marker_test {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr double kRoundoff = 1e-12;

mesh::Mesh example_mesh() {
  auto mesh = test::distorted(test::brick({3, 2, 2}, {2, 1, 0.5}), 0.03);
  mesh.node_sets["line"] = {0, 1};
  return mesh;
}

// u = a + b x X at all nodes.
VectorXd rigid_field(const mesh::Mesh& mesh, const Vector3d& a, const Vector3d& b) {
  VectorXd u(3 * mesh.n_nodes());
  for (int i = 0; i < mesh.n_nodes(); ++i) u.segment<3>(3 * i) = a + b.cross(Vector3d(mesh.X.col(i)));
  return u;
}

TEST(Marker, moves_with_a_rigid_motion_of_its_nodes) {
  const mesh::Mesh mesh = example_mesh();
  const Vector3d a(1, -2, 3), b(0.3, 0.2, -0.7);
  const auto markers = reduction::make_markers(mesh, {"xmax", "zmin"});
  const VectorXd motion = reduction::marker_operator(mesh, {"xmax", "zmin"}) * rigid_field(mesh, a, b);
  for (int i : {0, 1}) {
    EXPECT_TRUE(markers[i].turns);
    EXPECT_LT((motion.segment<3>(6 * i) - a - b.cross(markers[i].X)).norm(), kRoundoff);
    EXPECT_LT((motion.segment<3>(6 * i + 3) - b).norm(), kRoundoff);
  }
}

// The rotation that leaves the least squares of u - mean - theta x r.
TEST(Marker, has_the_rotation_of_least_squares) {
  mesh::Mesh mesh = example_mesh();
  auto& nodes = mesh.node_sets.at("xmax");
  nodes.insert(nodes.begin(), 0);  // at another end: sides do not hold all of them, they weigh the same
  const VectorXd u = VectorXd::Random(3 * mesh.n_nodes());
  const Vector6 motion = reduction::marker_operator(mesh, {"xmax"}) * u;
  Vector3d gradient = Vector3d::Zero(), mean = mesh.X(Eigen::all, nodes).rowwise().mean();
  double size = 0;
  for (int node : nodes) {
    const Vector3d r = mesh.X.col(node) - mean;
    const Vector3d rest = u.segment<3>(3 * node) - motion.head<3>() - motion.tail<3>().cross(r);
    gradient += r.cross(rest);
    size += r.norm() * rest.norm();
  }
  EXPECT_LT(gradient.norm(), kRoundoff * size);
}

// A face of 2 x 1 cells with the middle line far on one side: nodes gather there, area does not.
TEST(Marker, weighed_by_area_lies_at_the_centre_of_its_surface_and_turns_with_it) {
  mesh::Mesh mesh = test::brick({2, 2, 1}, {2, 1, 1});
  for (int i = 0; i < mesh.n_nodes(); ++i)
    if (mesh.X(0, i) == 1) mesh.X(0, i) = 0.2;
  mesh.node_sets["and_another"] = mesh.node_sets.at("zmin");
  mesh.node_sets["and_another"].push_back(mesh.n_nodes() - 1);
  EXPECT_NEAR(reduction::make_markers(mesh, {"and_another"})[0].X.x(), (3 * 2.2 + 2) / 10, kRoundoff);
  const auto markers = reduction::make_markers(mesh, {"zmin"});
  EXPECT_LT((markers[0].X - Vector3d(1, 0.5, 0)).norm(), kRoundoff);
  const Vector3d a(1, -2, 3), b(0.3, 0.2, -0.7);
  const VectorXd motion = reduction::marker_operator(mesh, {"zmin"}) * rigid_field(mesh, a, b);
  EXPECT_LT((motion.head<3>() - a - b.cross(markers[0].X)).norm(), kRoundoff);
  EXPECT_LT((motion.segment<3>(3) - b).norm(), kRoundoff);
}

// An even traction on sides of second order: -1/12 of it at corners, 1/3 at midside nodes, 1/6 where two
// sides have a corner. Of a triangle the corners have none.
TEST(Marker, weighed_by_area_spreads_a_force_as_an_even_traction) {
  using mesh::CellType;
  const auto weights = [](CellType type) {
    const mesh::Mesh mesh = test::cells_of(type, test::brick({1, 1, 1}, {1, 1, 1}));
    const auto Q = reduction::marker_operator(mesh, {"zmin"});
    std::vector<double> all;
    for (int node : mesh.node_sets.at("zmin")) all.push_back(Q.coeff(0, 3 * node));
    std::sort(all.begin(), all.end());
    return all;
  };
  const std::vector<double> hexahedra = weights(CellType::hex20), tetrahedra = weights(CellType::tet10);
  ASSERT_EQ(hexahedra.size(), 8u);
  for (int i = 0; i < 8; ++i) EXPECT_NEAR(hexahedra[i], i < 4 ? -1.0 / 12 : 1.0 / 3, kRoundoff);
  ASSERT_EQ(tetrahedra.size(), 9u);
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(tetrahedra[i], i < 4 ? 0 : i < 8 ? 1.0 / 6 : 1.0 / 3, kRoundoff);
}

// Moments are tractions in proportion to the distance: the second moment is that of the area.
TEST(Marker, weighed_by_area_has_the_second_moment_of_its_surface) {
  for (mesh::CellType type : {mesh::CellType::hex8, mesh::CellType::hex20, mesh::CellType::tet10}) {
    const mesh::Mesh mesh = test::cells_of(type, test::brick({2, 1, 1}, {3, 1, 1}));
    const auto Q = reduction::marker_operator(mesh, {"zmin"});
    VectorXd bent =
        VectorXd::Zero(3 * mesh.n_nodes());  // w = x y about the centre: neither moves nor turns it
    for (int i = 0; i < mesh.n_nodes(); ++i) bent[3 * i + 2] = (mesh.X(0, i) - 1.5) * (mesh.X(1, i) - 0.5);
    EXPECT_LT((Q * bent).head<6>().norm(), kRoundoff);
    const Vector3d a(1, -2, 3), b(0.3, 0.2, -0.7), centre(1.5, 0.5, 0);
    const VectorXd motion = Q * rigid_field(mesh, a, b);
    EXPECT_LT((motion.head<3>() - a - b.cross(centre)).norm(), kRoundoff);
    EXPECT_LT((motion.segment<3>(3) - b).norm(), kRoundoff);
  }
}

// The sides of a closed surface sum up to nothing, and sweep three times its volume when all grows by itself.
TEST(Marker, of_faces_has_the_volume_that_a_pressure_works_on) {
  for (mesh::CellType type : {mesh::CellType::hex8, mesh::CellType::hex20, mesh::CellType::tet10}) {
    mesh::Mesh mesh = test::cells_of(type, test::brick({2, 1, 1}, {3, 1, 2}));
    mesh.face_sets = {{"all", mesh::boundary_faces(mesh)}, {"end", {}}};
    for (const mesh::Face& face : mesh.face_sets["all"])
      if (std::all_of(face.begin(), face.end(), [&](int node) { return mesh.X(0, node) == 3; }))
        mesh.face_sets["end"].push_back(face);
    const auto markers = reduction::make_markers(mesh, {"all", "end"});
    ASSERT_EQ(markers.size(), 4u);
    EXPECT_EQ(markers[3].name, model::pressure_marker("end"));
    EXPECT_LT(markers[1].area->sum.norm() + markers[1].area->moment.norm(), kRoundoff);
    EXPECT_LT((markers[3].area->sum - Vector3d(2, 0, 0)).norm(), kRoundoff);
    EXPECT_LT((markers[3].area->moment - Vector3d(0, 2, -1)).norm(), kRoundoff);
    const Eigen::MatrixXd Q = reduction::marker_operator(mesh, {"all", "end"});
    EXPECT_NEAR(Q.row(6).dot(mesh.X.reshaped()), 3 * 6, kRoundoff);
    EXPECT_NEAR(Q.row(18).dot(rigid_field(mesh, {1, -2, 3}, {0.3, 0.2, -0.7})), 2 * (1 + 0.2 * 1 + 0.7 * 0.5),
                kRoundoff);
    EXPECT_EQ(Q.middleRows(7, 5).norm() + Q.middleRows(19, 5).norm(), 0);
  }
}

TEST(Marker, on_a_line_has_no_rotation) {
  const mesh::Mesh mesh = example_mesh();
  EXPECT_FALSE(reduction::make_markers(mesh, {"line"})[0].turns);
  const auto Q = reduction::marker_operator(mesh, {"line"});
  EXPECT_EQ(Eigen::MatrixXd(Q).bottomRows<3>().norm(), 0);
  EXPECT_GT(Eigen::MatrixXd(Q).topRows<3>().norm(), 0);
}

TEST(Marker, refuses_sets_that_make_none) {
  const mesh::Mesh mesh = example_mesh();
  EXPECT_THROW(reduction::make_markers(mesh, {"nowhere"}), Error);
  EXPECT_THROW(reduction::make_markers(mesh, {"xmax", "xmax"}), Error);
  auto named_frame = mesh;
  named_frame.node_sets["frame"] = {0, 1, 2};
  EXPECT_THROW(reduction::make_markers(named_frame, {"frame"}), Error);
}

TEST(Marker, has_the_same_rows_in_the_full_basis_as_in_unit_modes) {
  const mesh::Mesh mesh = example_mesh();
  const std::vector<std::string> sets = {"xmax", "zmin"};
  const auto moments = fem::mass_moments(mesh, test::kSteelBody);
  const auto free_dof = fem::free_dofs(fem::held_directions(mesh, {"xmin"}));
  const auto n = static_cast<int>(free_dof.size());
  const auto Q = reduction::marker_operator(mesh, sets);
  model::ElasticBody full, modal;
  full.markers = modal.markers = reduction::make_markers(mesh, sets);
  reduction::set_full_basis(full, free_dof, moments, Q);
  reduction::allocate_modes(modal, n);
  for (int k = 0; k < n; ++k)
    reduction::set_mode(
        modal, k, reduction::mode_column(modal, VectorXd::Unit(3 * mesh.n_nodes(), free_dof[k]), moments, Q));
  const VectorXd q = VectorXd::Random(n);
  for (int i : {0, 1}) {
    const VectorXd motion = model::multiply(full.markers[i].Phi, q);
    EXPECT_LT((motion - model::multiply(modal.markers[i].Phi, q)).norm(), kRoundoff * motion.norm());
    EXPECT_GT(motion.norm(), 0);
  }
}

}  // namespace
}  // namespace elastogear::marker_test
