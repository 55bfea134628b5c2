#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <set>

#include "../fem/other_cells.h"
#include "elastogear/base/error.h"
#include "elastogear/mesh/partition.h"

namespace elastogear::cell_type_test {
namespace {

using mesh::CellType;
using mesh::Face;
using mesh::Mesh;

constexpr double kRoundoff = 1e-13;

struct Cell : testing::TestWithParam<CellType> {};
INSTANTIATE_TEST_SUITE_P(Types, Cell, testing::ValuesIn(test::all_cell_types()),
                         [](const auto& info) { return mesh::name(info.param); });

// Twice the vector area and six times the enclosed volume of plane faces.
struct Enclosed {
  Eigen::Vector3d area = Eigen::Vector3d::Zero();
  double volume = 0;
};

Enclosed enclosed(const Mesh& mesh, const std::vector<Face>& faces) {
  Enclosed sum;
  for (const Face& f : faces)
    for (const auto& [a, b, c] : {std::array{f[0], f[1], f[2]}, std::array{f[0], f[2], f[3]}}) {
      const Eigen::Vector3d u = mesh.X.col(b) - mesh.X.col(a), v = mesh.X.col(c) - mesh.X.col(a);
      sum.area += u.cross(v);
      sum.volume += u.cross(v).dot(mesh.X.col(a));
    }
  return sum;
}

TEST_P(Cell, faces_enclose_it_outward) {
  const Mesh mesh = test::cells_of(GetParam(), test::brick({1, 1, 1}, {2, 1, 0.5}));
  double volume = 0;
  for (int i = 0; i < mesh.cells.size(); ++i) {
    const auto e = enclosed(mesh, mesh::cell_faces(mesh.cells.type[i], mesh.cells[i]));
    EXPECT_LT(e.area.norm(), kRoundoff);
    EXPECT_GT(e.volume, 0);
    volume += e.volume / 6;
  }
  EXPECT_NEAR(volume, 1, kRoundoff);
}

TEST_P(Cell, faces_use_every_node) {
  std::vector<int> nodes(mesh::node_count(GetParam()));
  std::iota(nodes.begin(), nodes.end(), 0);
  std::set<int> used;
  for (const Face& face : mesh::cell_faces(GetParam(), nodes)) used.insert(face.begin(), face.end());
  EXPECT_EQ(used, std::set<int>(nodes.begin(), nodes.end()));
}

TEST_P(Cell, sides_cancel_between_neighbours) {
  const Mesh mesh = test::cells_of(GetParam(), test::distorted(test::brick({3, 3, 3}, {1, 1, 1}), 0.05));
  mesh::validate(mesh, "patch");
  std::vector<int> cell;
  const auto faces = mesh::boundary_faces(mesh, &cell);
  EXPECT_EQ(faces.size(), cell.size());
  EXPECT_NEAR(enclosed(mesh, faces).volume / 6, 1, kRoundoff);
  for (const Face& face : faces)
    for (int node : face)
      EXPECT_TRUE((mesh.X.col(node).array() < kRoundoff || mesh.X.col(node).array() > 1 - kRoundoff).any());
}

TEST_P(Cell, partition_cuts_a_bar_across) {
  const Mesh mesh = test::cells_of(GetParam(), test::brick({8, 1, 1}, {8, 1, 1}));
  const auto halves = mesh::partition_cells(mesh, 2);

  EXPECT_LE(halves.edge_cut, 8);
  EXPECT_GT(halves.edge_cut, 0);
}

TEST(MixedMesh, sides_cancel_between_cells_of_different_types) {
  for (const Mesh& mesh :
       {test::mixed(test::brick({4, 4, 4}, {1, 1, 1}), 4),
        test::second_order(test::hexahedra_and_wedges(test::brick({4, 4, 4}, {1, 1, 1}), 4))}) {
    mesh::validate(mesh, "mixed");
    EXPECT_GT(std::set<CellType>(mesh.cells.type.begin(), mesh.cells.type.end()).size(), 1u);
    const auto e = enclosed(mesh, mesh::boundary_faces(mesh));
    EXPECT_NEAR(e.volume / 6, 1, kRoundoff);
    EXPECT_LT(e.area.norm(), kRoundoff);
  }
}

TEST(FaceKey, of_a_triangle_is_the_same_in_all_directions_and_never_a_quadrilateral) {
  const Face key = mesh::face_key({7, 3, 5, 5});
  EXPECT_EQ(key, mesh::face_key({3, 5, 7, 7}));
  EXPECT_EQ(key, mesh::face_key({5, 3, 7, 7}));
  EXPECT_NE(key, mesh::face_key({3, 5, 7, 8}));
  EXPECT_TRUE(mesh::same_direction({7, 3, 5, 5}, {5, 7, 3, 3}));
  EXPECT_FALSE(mesh::same_direction({7, 3, 5, 5}, {7, 5, 3, 3}));
}

TEST(SideFaces, of_an_impossible_side_are_an_error) {
  EXPECT_THROW(mesh::side_faces(std::vector{1, 2, 3, 4, 5}), Error);
}

}  // namespace
}  // namespace elastogear::cell_type_test
