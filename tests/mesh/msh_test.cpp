#include <Eigen/Geometry>

#include "mesh/msh/msh.h"
#include "mesh/msh/msh_format.h"
#include "reader_test.h"

namespace elastogear::msh_test {
using namespace mesh;
using testing::HasSubstr;

namespace {

// A cube as Gmsh itself may write it: gaps in the numbering, several blocks, lines and triangles, a
// quadrangle turned inward, a group without a name.
const std::string kCube = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$Comments
nothing
$EndComments
$PhysicalNames
2
2 7 "top side"
3 9 "all"
$EndPhysicalNames
$Entities
1 0 1 1
1 0 0 0 1 4
1 0 0 0 1 1 1 1 -7 0
1 0 0 0 1 1 1 1 9 1 1
$EndEntities
$Nodes
2 8 10 50
2 1 1 4
40
50
20
30
0 1 1 0 0
0 0 1 0 0
1 0 1 0 0
1 1 1 0 0
3 1 0 4
10
11
12
13
0 0 0
1 0 0
1 1 0
0 1 0
$EndNodes
$Elements
4 4 1 9
0 1 15 1
1 11
1 1 1 1
2 10 11
2 1 3 1
3 50 40 30 20
3 1 5 1
9 10 11 12 13 50 20 30 40
$EndElements
)";

struct Msh : ReaderTest {
  Msh() : ReaderTest("cube.msh", kCube) {}
};

TEST_F(Msh, numbers_nodes_by_their_tags) {
  const Mesh mesh = read(kCube);
  ASSERT_EQ(mesh.n_nodes(), 8);
  EXPECT_EQ(mesh.X.col(1), Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(mesh.X.col(4), Eigen::Vector3d(1, 0, 1));
  EXPECT_EQ(mesh.X.col(7), Eigen::Vector3d(0, 0, 1));
}

TEST_F(Msh, turns_faces_outward) {
  const Mesh mesh = read(kCube);
  const Face& top = mesh.face_sets.at("top side").at(0);
  const Eigen::Vector3d a = mesh.X.col(top[1]) - mesh.X.col(top[0]),
                        b = mesh.X.col(top[2]) - mesh.X.col(top[1]);
  EXPECT_EQ(a.cross(b), Eigen::Vector3d(0, 0, 1));
}

TEST_F(Msh, reads_groups_without_a_name_and_reports_what_it_leaves_out) {
  ReadReport report;
  const Mesh mesh = read(kCube, &report);
  EXPECT_EQ(mesh.node_sets.at("physical_4"), std::vector<int>{1});
  EXPECT_THAT(report.node_number, testing::ElementsAre(10, 11, 12, 13, 20, 30, 40, 50));
  EXPECT_EQ(mesh.cell_sets.at("all"), std::vector<int>{0});
  EXPECT_THAT(report.ignored, testing::UnorderedElementsAre("lines that are in no set (1)"));
}

TEST_F(Msh, tells_sections_that_change_the_mesh_from_those_that_do_not) {
  const auto with = [](const std::string& section) {
    return kCube + section + "\n1 2\n$End" + section.substr(1) + "\n";
  };
  ReadReport report;
  read(with("$Periodic") + "$NodeData\n1\n$EndNodeData\n", &report);
  EXPECT_THAT(report.lost, testing::IsEmpty());
  read(with("$Surprise"), &report);
  EXPECT_THAT(report.lost, testing::ElementsAre("section $Surprise (1): not known, and left out"));
  EXPECT_THAT(error_of(with("$PartitionedEntities")), HasSubstr("save it without partitions"));
  EXPECT_THAT(error_of(with("$PhysicalNames")), HasSubstr("stands behind $Elements"));
  EXPECT_THAT(error("3 1 5 1", "3 1 12 1"), HasSubstr("Mesh.SecondOrderIncomplete=1"));
}

TEST_F(Msh, keeps_nodes_and_cells_in_the_order_of_their_tags_whatever_the_blocks) {
  const Mesh mesh = box_mesh_with_sets({4, 3, 2});
  write_msh(path, mesh, Encoding::ascii);
  EXPECT_THAT(read_file(path), HasSubstr("$Entities\n3 0 3 5\n"));  // volumes: the sets' combinations
  EXPECT_TRUE(equal(read_msh(path), mesh));
}

// Midside nodes in Gmsh's order by the corners they lie between (Gmsh reference manual, node ordering).
struct GmshEdges {
  CellType type;
  std::vector<std::array<int, 2>> edges;
};
const GmshEdges kGmshEdges[] = {
    {CellType::tet10, {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {2, 3}, {1, 3}}},
    {CellType::hex20,
     {{0, 1}, {0, 3}, {0, 4}, {1, 2}, {1, 5}, {2, 3}, {2, 6}, {3, 7}, {4, 5}, {4, 7}, {5, 6}, {6, 7}}},
    {CellType::wedge15, {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 4}, {2, 5}, {3, 4}, {3, 5}, {4, 5}}}};

TEST(MshFormat, finds_every_midside_node_between_the_corners_that_gmsh_puts_it) {
  for (const GmshEdges& gmsh : kGmshEdges) {
    const int corners = corner_count(gmsh.type);
    const auto position = msh_format::gmsh_position(gmsh.type);
    ASSERT_EQ(std::ssize(position), node_count(gmsh.type));
    for (int e = 0; e < std::ssize(edges(gmsh.type)); ++e) {
      auto ours = edges(gmsh.type)[e], theirs = gmsh.edges.at(position[corners + e] - corners);
      std::sort(ours.begin(), ours.end());
      std::sort(theirs.begin(), theirs.end());
      EXPECT_EQ(ours, theirs) << name(gmsh.type) << " edge " << e;
    }
  }
}

TEST_F(Msh, reads_second_order_faces_as_the_parts_of_their_cells_sides) {
  const std::string cell = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
1
2 1 "skin"
$EndPhysicalNames
$Entities
0 0 1 1
1 0 0 0 1 1 1 1 1 0
1 0 0 0 1 1 1 0 0
$EndEntities
$Nodes
1 10 1 10
3 1 0 10
1
2
3
4
5
6
7
8
9
10
0 0 0
2 0 0
0 2 0
0 0 2
1 0 0
1 1 0
0 1 0
0 0 1
0 1 1
1 0 1
$EndNodes
$Elements
2 2 1 2
2 1 9 1
1 2 3 4 6 9 10
3 1 11 1
2 1 2 3 4 5 6 7 8 9 10
$EndElements
)";
  const Mesh mesh = read(cell);
  ASSERT_EQ(mesh.cells.type, std::vector{CellType::tet10});
  for (int e = 0; e < 6; ++e) {
    const auto [a, b] = edges(CellType::tet10)[e];
    EXPECT_EQ(mesh.X.col(mesh.cells[0][4 + e]),
              (mesh.X.col(mesh.cells[0][a]) + mesh.X.col(mesh.cells[0][b])) / 2);
  }
  const auto side = cell_sides(CellType::tet10, mesh.cells[0])[2];
  EXPECT_THAT(mesh.face_sets.at("skin"), testing::UnorderedElementsAreArray(side));
}

TEST_F(Msh, names_line_and_value_of_hostile_input) {
  EXPECT_THAT(error("4.1 0 8", "2.2 0 8"), HasSubstr("line 2: MSH version 2.2"));
  EXPECT_THAT(error("4.1 0 8", "4.1 0 4"), HasSubstr("data size 4"));
  EXPECT_THAT(error("1 0 0\n1 1 0", "1 nan 0\n1 1 0"), HasSubstr("line 35: a node coordinate is nan"));
  EXPECT_THAT(error("1 0 0\n1 1 0", "1 inf 0\n1 1 0"), HasSubstr("a node coordinate is inf"));
  EXPECT_THAT(error("1 0 0\n1 1 0", "1 0,5 0\n1 1 0"), HasSubstr("'0,5', must be a number"));
  EXPECT_THAT(error("50 20 30 40\n$End", "50 20 30 41\n$End"), HasSubstr("cell 9 names node 41"));
  EXPECT_THAT(error("\n3 50 40 30 20", "\n3 50 40 30 21"), HasSubstr("face set 'top side' names node 21"));
  EXPECT_THAT(error("\n12\n", "\n11\n"), HasSubstr("node 11 is defined twice"));
  EXPECT_THAT(error("\n12\n", "\n-12\n"), HasSubstr("a node number is '-12'"));
  EXPECT_THAT(error("\n12\n", "\n0\n"), HasSubstr("a node number is 0"));
  EXPECT_THAT(error("3 1 0 4", "3 1 0 3"), HasSubstr("line"));
  EXPECT_THAT(error("3 1 0 4", "3 1 0 5"), HasSubstr("line"));
  EXPECT_THAT(error("2 8 10 50", "2 9 10 50"), HasSubstr("announces 9 nodes and holds 8"));
  EXPECT_THAT(error("2 8 10 50", "2 999999999999999 10 50"), HasSubstr("only"));
  EXPECT_THAT(error("4 4 1 9", "4 5 1 9"), HasSubstr("announces 5 elements and holds 4"));
  EXPECT_THAT(error("3 1 5 1", "3 1 12 1"), HasSubstr("element type 12"));
  EXPECT_THAT(
      error("\n3 50 40 30 20", "\n3 50 40 30 10"),
      HasSubstr(
          "face set 'top side' holds the face of node 50, node 40, node 30, node 10, which is no face"));
  EXPECT_THAT(error("9 10 11 12 13", "9 10 11 12 12"), HasSubstr("cell 9 repeats a node, node 12"));
  EXPECT_THAT(error("$Elements", "$Nodes"), HasSubstr("a second section $Nodes"));
  EXPECT_THAT(error("4 4 1 9", "3 3 1 9"), HasSubstr("expected $EndElements"));
}

}  // namespace
}  // namespace elastogear::msh_test
