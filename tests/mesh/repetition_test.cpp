#include "elastogear/mesh/repetition.h"

#include <gtest/gtest.h>

#include "../fem/brick.h"
#include "disc.h"
#include "elastogear/base/rotation.h"
#include "elastogear/gear/wheel.h"
#include "elastogear/gear/worm.h"

namespace elastogear::repetition_test {
namespace {

constexpr double kSamePlace = 1e-12;  // m: roundoff of a turned position

mesh::Mesh wheel() { return gear::wheel_mesh({}, gear::wheel_counts(gear::Size::tiny)); }

struct OwnLabels {
  std::vector<int> cell;
  std::vector<bool> node;

  explicit OwnLabels(const mesh::Mesh& mesh)
      : cell(static_cast<std::size_t>(mesh.cells.size()), 0),
        node(static_cast<std::size_t>(mesh.n_nodes()), true) {}
};

mesh::RepetitionSearch search(const mesh::Mesh& mesh, const OwnLabels& labels) {
  return mesh::find_repetition(mesh, {labels.cell, labels.node});
}
mesh::RepetitionSearch search(const mesh::Mesh& mesh) { return search(mesh, OwnLabels(mesh)); }

// Every node is the first of its orbit, turned as often as stated; cells fill the mesh.
void expect_consistent(const mesh::Mesh& mesh, const mesh::Repetition& r) {
  std::map<int, int> first;
  for (int node = 0; node < mesh.n_nodes(); ++node)
    if (r.sector_index[node] == 0) {
      EXPECT_TRUE(first.try_emplace(r.orbit[node], node).second) << node;
    }
  const auto n_first = static_cast<int>(r.on_axis.size());
  EXPECT_EQ(static_cast<int>(first.size()), n_first);
  for (int node = 0; node < mesh.n_nodes(); ++node) {
    const double angle = 2 * M_PI * r.sector_index[node] / r.turn.n_sectors;
    const Eigen::Vector3d x = mesh.X.col(first.at(r.orbit[node])) - r.turn.point;
    const Eigen::Vector3d image = r.turn.point + rotation_matrix(angle * r.turn.axis) * x;
    EXPECT_LT((image - mesh.X.col(node)).norm(), kSamePlace) << node;
  }
  EXPECT_EQ(std::accumulate(r.cell_count.begin(), r.cell_count.end(), 0), mesh.cells.size());
}

TEST(Repetition, of_a_wheel_is_its_teeth_in_any_numbering) {
  for (const mesh::Mesh& mesh : {wheel(), test::shuffled(wheel())}) {
    const auto [found, reason] = search(mesh);
    ASSERT_TRUE(found) << reason;
    EXPECT_EQ(found->turn.n_sectors, 41);
    EXPECT_LT((found->turn.axis - Eigen::Vector3d::UnitZ()).norm(), kSamePlace);
    expect_consistent(mesh, *found);
  }
}

TEST(Repetition, does_not_depend_on_where_the_body_is) {
  const Eigen::Matrix3d R = rotation_matrix({0.3, -0.8, 1.1});
  const auto mesh = test::mapped(wheel(), [&](const Eigen::Vector3d& x) -> Eigen::Vector3d {
    return R * x + Eigen::Vector3d(0.1, 0.2, -0.3);
  });
  const auto [found, reason] = search(mesh);
  ASSERT_TRUE(found) << reason;
  EXPECT_EQ(found->turn.n_sectors, 41);
  EXPECT_GT(std::abs(found->turn.axis.dot(R.col(2))), 1 - kSamePlace);
}

TEST(Repetition, survives_roundoff_of_positions) {
  auto mesh = wheel();
  mesh.X += 1e-9 * mesh.X.cwiseAbs().maxCoeff() * Eigen::Matrix3Xd::Random(3, mesh.n_nodes());
  EXPECT_TRUE(search(mesh).found) << search(mesh).reason;
}

TEST(Repetition, keeps_nodes_on_the_axis_to_themselves) {
  const auto mesh = test::shuffled(test::disc({6, 2, 3, 2}));
  const auto [found, reason] = search(mesh);
  ASSERT_TRUE(found) << reason;
  EXPECT_EQ(found->turn.n_sectors, 6);
  EXPECT_EQ(std::count(found->on_axis.begin(), found->on_axis.end(), true), 3);
  expect_consistent(mesh, *found);
}

TEST(Repetition, of_a_square_prism_has_cells_around_the_axis) {
  const auto mesh = test::brick({3, 3, 2}, {1, 1, 0.5});
  const auto [found, reason] = search(mesh);
  ASSERT_TRUE(found) << reason;
  EXPECT_EQ(found->turn.n_sectors, 4);
  EXPECT_EQ(std::count(found->cell_count.begin(), found->cell_count.end(), 1), 2);
  expect_consistent(mesh, *found);
}

void expect_none(const mesh::RepetitionSearch& result, const std::string& part) {
  EXPECT_FALSE(result.found);
  EXPECT_NE(result.reason.find(part), std::string::npos) << result.reason;
}

TEST(Repetition, is_refused_when_one_node_is_off) {
  auto mesh = wheel();
  const int node = 1234;
  mesh.X(0, node) += 1e-3 * 1e-3;  // of edges of about 1 mm
  expect_none(search(mesh), "node");
}

TEST(Repetition, is_refused_for_one_cell_of_another_material) {
  const auto mesh = wheel();
  OwnLabels labels(mesh);
  labels.cell[321] = 1;
  expect_none(search(mesh, labels), "cell");
}

TEST(Repetition, is_refused_for_one_node_more_restrained) {
  const auto mesh = wheel();
  OwnLabels labels(mesh);
  labels.node[777] = false;
  expect_none(search(mesh, labels), "node");
}

TEST(Repetition, is_refused_for_cells_cut_differently) {
  const auto hexahedra = test::disc({4, 1, 2, 1});
  auto mesh = hexahedra;
  mesh.cells = {};
  for (int cell = 0; cell < hexahedra.cells.size(); ++cell) {
    const auto c = hexahedra.cells[cell];
    if (cell != 3) {
      mesh.cells.add(hexahedra.cells.type[cell], c);
      continue;
    }
    mesh.cells.add(mesh::CellType::wedge6, std::array{c[0], c[1], c[2], c[4], c[5], c[6]});
    mesh.cells.add(mesh::CellType::wedge6, std::array{c[0], c[2], c[3], c[4], c[6], c[7]});
  }
  expect_none(search(mesh), "cell");
}

TEST(Repetition, with_coincident_nodes_is_refused) {
  auto mesh = test::disc({5, 1, 2, 1});
  const int twin = mesh.n_nodes();
  mesh.X.conservativeResize(3, twin + 1);
  mesh.X.col(twin) = mesh.X.col(mesh.cells.nodes.back());
  mesh.cells.nodes.back() = twin;
  EXPECT_FALSE(search(mesh).found);
}

TEST(Repetition, ignores_nodes_in_no_cell) {
  auto mesh = test::disc({5, 1, 2, 1});
  mesh.X.conservativeResize(3, mesh.n_nodes() + 1);
  mesh.X.rightCols<1>() << 3, 4, 5;
  const auto found = search(mesh).found;
  ASSERT_TRUE(found);
  EXPECT_EQ(found->turn.n_sectors, 5);
  EXPECT_EQ(found->orbit.back(), -1);
}

TEST(Repetition, of_a_worm_is_its_threads) {
  const auto mesh = gear::worm_mesh({}, gear::worm_counts(gear::Size::tiny));
  const auto [found, reason] = search(mesh);
  ASSERT_TRUE(found) << reason;
  EXPECT_EQ(found->turn.n_sectors, 2);
}

}  // namespace
}  // namespace elastogear::repetition_test
