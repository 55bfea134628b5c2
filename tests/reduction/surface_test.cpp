#include "reduction/job/surface.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "../fem/other_cells.h"
#include "elastogear/base/error.h"

namespace elastogear::surface_test {
namespace {

constexpr double kRoundoff = 1e-12;

TEST(Surface, groups_are_the_smallest_sets_then_the_first_by_name) {
  auto mesh = test::brick({4, 2, 1}, {4, 2, 3});
  auto& sets = mesh.face_sets;
  sets["flanks"] = sets["zmin"];
  sets["flanks"].insert(sets["flanks"].end(), sets["zmax"].begin(), sets["zmax"].end());
  sets["lower"] = sets["zmin"];            // as large as zmin, earlier in the alphabet
  sets["tooth"] = {sets["zmax"].front()};  // smaller than zmax
  const auto surface = reduction::make_surface(mesh, test::kSteelBody, {"flanks", "zmax"});
  EXPECT_EQ(surface.group_name, (std::vector<std::string>{"lower", "tooth", "zmax"}));
  ASSERT_EQ(surface.face.cols(), 16);
  EXPECT_EQ(surface.group, (std::vector<int>{0, 0, 0, 0, 0, 0, 0, 0, 1, 2, 2, 2, 2, 2, 2, 2}));
}

// On a brick of cells 1 x 1 x 3.
void expect_outward_and_stiff(const mesh::Mesh& mesh) {
  const auto surface = reduction::make_surface(mesh, test::kSteelBody, {"surface"});
  for (int i = 0; i < surface.face.cols(); ++i) {
    const Eigen::Matrix3Xd x = surface.X(Eigen::all, surface.face.col(i));
    const Eigen::Vector3d n = (x.col(2) - x.col(0)).cross(x.col(3) - x.col(1)) / 2;
    EXPECT_GT(n.dot(x.rowwise().mean() - Eigen::Vector3d(2, 1, 1.5)), 0);
    const double depth =
        n.normalized().cwiseAbs().dot(Eigen::Vector3d(1, 1, 3));  // of a cell behind the face
    EXPECT_NEAR(surface.c_f(i) * depth / test::kSteel.E, 1, kRoundoff);
  }
  for (std::size_t i = 0; i < surface.node.size(); ++i)
    EXPECT_EQ(surface.X.col(static_cast<int>(i)), mesh.X.col(surface.node[i]));
}

TEST(Surface, faces_look_outward_and_know_the_stiffness_behind_them) {
  expect_outward_and_stiff(test::brick({4, 2, 1}, {4, 2, 3}));
}

TEST(Surface, parts_of_a_second_order_side_have_the_stiffness_of_the_whole) {
  expect_outward_and_stiff(test::second_order(test::brick({4, 2, 1}, {4, 2, 3})));
}

TEST(Surface, inside_the_body_is_an_error_and_so_is_an_unknown_set) {
  auto mesh = test::brick({2, 1, 1}, {2, 1, 1});
  mesh.face_sets["inside"] = {mesh::cell_faces(mesh::CellType::hex8, mesh.cells[0])[3]};
  EXPECT_THROW(reduction::make_surface(mesh, test::kSteelBody, {"inside"}), Error);
  EXPECT_THROW(reduction::make_surface(mesh, test::kSteelBody, {"flanks"}), Error);
  EXPECT_EQ(reduction::make_surface(mesh, test::kSteelBody, {}).face.cols(), 0);
}

}  // namespace
}  // namespace elastogear::surface_test
