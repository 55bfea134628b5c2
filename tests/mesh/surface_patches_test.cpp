#include "elastogear/mesh/surface_patches.h"

#include <gtest/gtest.h>

#include "../fem/brick.h"
#include "../fem/other_cells.h"

namespace elastogear::surface_patches_test {
namespace {

using mesh::Mesh;

int node_at(const Mesh& mesh, const Eigen::Vector3d& x) {
  Eigen::Index nearest = 0;
  (mesh.X.colwise() - x).colwise().squaredNorm().minCoeff(&nearest);
  return static_cast<int>(nearest);
}

TEST(SurfacePatches, are_the_nodes_of_the_faces_at_a_node) {
  const Mesh cube = test::brick({2, 2, 2}, {2, 2, 2});
  const int corner = node_at(cube, {0, 0, 0}), side = node_at(cube, {1, 1, 0}),
            inside = node_at(cube, {1, 1, 1});
  const auto patches = mesh::surface_patches(cube, {side, inside, corner});
  EXPECT_EQ(patches[0].size(), 9U);
  for (int node : patches[0]) EXPECT_EQ(cube.X(2, node), 0);
  EXPECT_EQ(patches[1], std::vector<int>{inside});
  EXPECT_EQ(patches[2].size(), 7U);
}

TEST(CellOrders, are_those_of_the_displacements) {
  const Mesh linear = test::brick({2, 1, 1}, {1, 1, 1});
  EXPECT_EQ(mesh::cell_orders(linear, {0, 5}), (std::vector<int>{1, 1}));
  EXPECT_EQ(mesh::cell_orders(test::cells_of(mesh::CellType::hex20, linear), {3}), std::vector<int>{2});
  EXPECT_EQ(mesh::cell_orders(test::cells_of(mesh::CellType::tet10, linear), {3}), std::vector<int>{2});
}

}  // namespace
}  // namespace elastogear::surface_patches_test
