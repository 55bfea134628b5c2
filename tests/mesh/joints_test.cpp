// How cells hang together, in boxes that are broken on purpose.
#include "elastogear/mesh/joints.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "box_mesh.h"

namespace elastogear::mesh::joints_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

// A row of three cells whose last one has nodes of its own, `apart` (m) from those of the second.
Mesh cut_row(double apart) {
  Mesh mesh = box_mesh({2, 1, 1});
  const Mesh more = box_mesh({1, 1, 1});
  const int n = mesh.n_nodes();
  mesh.X.conservativeResize(3, n + more.n_nodes());
  mesh.X.rightCols(more.n_nodes()) = more.X;
  mesh.X.rightCols(more.n_nodes()).row(0).array() += mesh.X.row(0).maxCoeff() + apart;
  std::vector<int> nodes(more.cells[0].begin(), more.cells[0].end());
  for (int& node : nodes) node += n;
  mesh.cells.add(CellType::hex8, nodes);
  return mesh;
}

// Numbers of a file: nodes from 101, cells from 11 on.
ReadReport numbers(const Mesh& mesh) {
  ReadReport report;
  report.node_number.resize(static_cast<std::size_t>(mesh.n_nodes()));
  report.cell_number.resize(static_cast<std::size_t>(mesh.cells.size()));
  std::iota(report.node_number.begin(), report.node_number.end(), 101);
  std::iota(report.cell_number.begin(), report.cell_number.end(), 11);
  return report;
}

TEST(Joints, of_a_whole_mesh_have_no_fault) {
  const JointFaults faults = joint_faults(box_mesh({3, 2, 2}));
  EXPECT_EQ(faults.overlap, "");
  EXPECT_THAT(faults.open, IsEmpty());
}

TEST(Joints, of_a_cell_given_twice_overlap_whatever_the_order_of_its_nodes) {
  Mesh mesh = box_mesh({3, 1, 1});
  const std::vector<int> c(mesh.cells[1].begin(), mesh.cells[1].end());
  mesh.cells.add(CellType::hex8, std::array{c[1], c[2], c[3], c[0], c[5], c[6], c[7], c[4]});
  const JointFaults faults = joint_faults(mesh, numbers(mesh));
  EXPECT_THAT(faults.overlap, AllOf(HasSubstr("cells 12 and 14 fill the same place"),
                                    HasSubstr("face of nodes 10"), HasSubstr("delete one")));
}

TEST(Joints, of_a_cell_over_those_that_it_is_cut_into_overlap) {
  Mesh mesh = box_mesh({1, 1, 1});
  const std::vector<int> c(mesh.cells[0].begin(), mesh.cells[0].end());
  mesh.cells.add(CellType::wedge6, std::array{c[0], c[1], c[2], c[4], c[5], c[6]});
  mesh.cells.add(CellType::wedge6, std::array{c[0], c[2], c[3], c[4], c[6], c[7]});
  EXPECT_THAT(joint_faults(mesh).overlap, HasSubstr("cells 0 and 1 fill"));
  EXPECT_THAT(joint_faults(mesh).overlap, HasSubstr("the first of 2 such pairs"));
}

TEST(Joints, of_a_body_given_twice_with_nodes_of_its_own_overlap) {
  Mesh mesh = box_mesh({2, 1, 1});
  const Mesh once = mesh;
  mesh.X.conservativeResize(3, 2 * once.n_nodes());
  mesh.X.rightCols(once.n_nodes()) = once.X;
  for (int cell = 0; cell < once.cells.size(); ++cell) {
    std::vector<int> nodes(once.cells[cell].begin(), once.cells[cell].end());
    for (int& node : nodes) node += once.n_nodes();
    mesh.cells.add(CellType::hex8, nodes);
  }
  EXPECT_THAT(joint_faults(mesh).overlap, HasSubstr("the first of 2 such pairs"));
}

TEST(Joints, that_are_not_merged_are_open) {
  const double edge = 1e-3;  // about the shortest one
  for (double apart : {0., 1e-3 * edge, -1e-3 * edge}) {
    const Mesh mesh = cut_row(apart);
    const JointFaults faults = joint_faults(mesh, numbers(mesh));
    EXPECT_EQ(faults.overlap, "");
    ASSERT_EQ(faults.open.size(), 2u) << apart;
    EXPECT_THAT(faults.open[0], AllOf(HasSubstr("cells 12 and 13 touch without sharing all nodes"),
                                      HasSubstr("merge the nodes")));
    EXPECT_THAT(faults.open[1],
                HasSubstr("2 parts that share no node: 2 cells from cell 11 on, 1 cell from cell 13 on"));
  }
}

TEST(Joints, with_a_gap_are_parts) {
  const JointFaults faults = joint_faults(cut_row(0.1));
  ASSERT_EQ(faults.open.size(), 1u);
  EXPECT_THAT(faults.open[0], HasSubstr("2 parts that share no node"));
}

// The body hangs together beside the crack.
TEST(Joints, of_a_cracked_body_are_open_where_it_is_cracked) {
  Mesh mesh = box_mesh({2, 2, 1});
  const int n = mesh.n_nodes();
  mesh.X.conservativeResize(3, n + 2);
  for (int k : {0, 1}) mesh.X.col(n + k) = mesh.X.col(5 + 9 * k);  // at the end of the middle line
  for (int k = mesh.cells.offset[3]; k < mesh.cells.offset[4]; ++k)
    for (int i : {0, 1})
      if (mesh.cells.nodes[k] == 5 + 9 * i) mesh.cells.nodes[k] = n + i;
  const JointFaults faults = joint_faults(mesh);
  ASSERT_EQ(faults.open.size(), 1u);
  EXPECT_THAT(faults.open[0], HasSubstr("cells 1 and 3 touch"));
}

// Midside nodes on one side only.
TEST(Joints, of_linear_and_second_order_cells_are_open) {
  Mesh mesh = box_mesh({2, 1, 1});
  std::vector<int> nodes(mesh.cells[1].begin(), mesh.cells[1].end());
  for (const auto& [a, b] : edges(CellType::hex20)) {
    const Eigen::Vector3d middle = (mesh.X.col(nodes[a]) + mesh.X.col(nodes[b])) / 2;
    nodes.push_back(mesh.n_nodes());
    mesh.X.conservativeResize(3, mesh.n_nodes() + 1);
    mesh.X.rightCols<1>() = middle;
  }
  Mesh mixed;
  mixed.X = mesh.X;
  mixed.cells.add(CellType::hex8, mesh.cells[0]);
  mixed.cells.add(CellType::hex20, nodes);
  const JointFaults faults = joint_faults(mixed);
  ASSERT_EQ(faults.open.size(), 1u);
  EXPECT_THAT(faults.open[0], HasSubstr("cells 0 and 1 touch without sharing all nodes"));
}

TEST(Joints, of_inverted_cells_are_left_to_the_check_of_cells) {
  Mesh mesh = box_mesh({2, 1, 1});
  for (int i = 0; i < 4; ++i) std::swap(mesh.cells.nodes[8 + i], mesh.cells.nodes[12 + i]);
  EXPECT_EQ(joint_faults(mesh).overlap, "");
}

}  // namespace
}  // namespace elastogear::mesh::joints_test
