#include "mesh/inp/lines/inp.h"
#include "elastogear/mesh/quality.h"
#include "mesh/inp/cards/collapsed.h"
#include "reader_test.h"

namespace elastogear::inp_test {
using namespace mesh;
using testing::HasSubstr;

namespace {

const std::string kCube = R"(*Heading
 one cube
** a comment
*Node, nset=All
 10, 0., 0., 0.
 11, 1., 0., 0.
 12, 1., 1., 0.
 13, 0, 1, 0
 20, +0, 0, 1.0D+0
 21, 1, 0, 1
 22, 1, 1, 1
 23, 0, 1, 1
*Element, type=C3D8R,
 elset=Body
 5, 10, 11, 12, 13,
 20, 21, 22, 23
*Nset, nset=Mixed
 Bottom, 23
*Nset, nset=bottom, generate
 10, 13, 1
*Nset, nset=odd, generate
 11, 13, 2
*Elset, elset=again
 BODY
*Surface, name=skin
 body, S1
 5, s6
*Material, name=steel
*Elastic
 2.1e11, 0.3
)";

struct Inp : ReaderTest {
  Inp() : ReaderTest("cube.inp", kCube) {}
};

TEST_F(Inp, reads_nodes_elements_and_sets) {
  const Mesh mesh = read(kCube);
  ASSERT_EQ(mesh.n_nodes(), 8);
  EXPECT_EQ(mesh.X.col(4), Eigen::Vector3d(0, 0, 1));
  ASSERT_EQ(mesh.cells.size(), 1);
  EXPECT_THAT(mesh.cells[0], testing::ElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
  EXPECT_THAT(mesh.node_sets.at("All"), testing::SizeIs(8));
  EXPECT_EQ(mesh.node_sets.at("bottom"), (std::vector{0, 1, 2, 3}));
  EXPECT_EQ(mesh.node_sets.at("odd"), (std::vector{1, 3}));
  EXPECT_EQ(mesh.node_sets.at("Mixed"), (std::vector{0, 1, 2, 3, 7}));
  EXPECT_EQ(mesh.cell_sets.at("again"), std::vector{0});
  EXPECT_EQ(mesh.face_sets.at("skin"), (std::vector<Face>{{0, 3, 2, 1}, {3, 0, 4, 7}}));
}

TEST_F(Inp, reports_every_keyword_it_ignores) {
  ReadReport report;
  read(kCube, &report);
  EXPECT_THAT(report.ignored, testing::ElementsAre("*HEADING (line 1)"));
  EXPECT_THAT(report.node_number, testing::ElementsAre(10, 11, 12, 13, 20, 21, 22, 23));
}

TEST_F(Inp, leaves_shells_out_and_reports_them) {
  ReadReport report;
  const std::string shell = "*Element, type=CPS4, elset=shell\n 90, 10, 11,\n 12, 22\n";
  const Mesh mesh = read(kCube + shell + "*Elset, elset=both\n 5, 90\n", &report);
  EXPECT_EQ(mesh.cells.size(), 1);
  EXPECT_TRUE(mesh.cell_sets.at("shell").empty());
  EXPECT_EQ(mesh.cell_sets.at("both"), std::vector{0});
  EXPECT_FALSE(mesh.face_sets.contains("shell"));
  EXPECT_THAT(report.lost, testing::ElementsAre(
                               "*ELEMENT, TYPE=CPS4 (line 31): left out, a body is made of solids alone"));
}

TEST_F(Inp, reads_plane_elements_on_cells_as_face_sets) {
  ReadReport report;
  const std::string bottom = "*Element, type=CPS4, elset=Surface1\n 90, 10, 11, 12, 13\n",
                    side = "*Element, type=S3, elset=Surface2\n 91, 10, 11, 21\n";
  const Mesh mesh = read(kCube + bottom + bottom.substr(0, 27) + "Surface3\n 92, 20, 21, 22, 23\n" + side +
                             "*Elset, elset=both\n 5, 90\n",
                         &report);
  EXPECT_EQ(mesh.face_sets.at("Surface1"), (std::vector<Face>{{0, 3, 2, 1}})) << "turned outward";
  EXPECT_EQ(mesh.face_sets.at("Surface3"), (std::vector<Face>{{4, 5, 6, 7}}));
  EXPECT_TRUE(mesh.face_sets.contains("both"));
  EXPECT_FALSE(mesh.face_sets.contains("Surface2")) << "half a side";
  EXPECT_THAT(
      report.ignored,
      testing::Contains("*ELEMENT, TYPE=CPS4 (line 31 and 1 more): faces of solids, read as face sets"));
  EXPECT_THAT(report.lost, testing::ElementsAre(HasSubstr("*ELEMENT, TYPE=S3 (line 35)")));
}

TEST_F(Inp, leaves_surfaces_of_shells_out_and_reads_the_rest) {
  ReadReport report;
  const Mesh mesh = read(kCube +
                             "*Element, type=S4, elset=shell\n 90, 10, 11, 12, 22\n*Surface, name=mixed\n"
                             " shell, SPOS\n 90, E1\n 5, S2\n",
                         &report);
  EXPECT_EQ(mesh.face_sets.at("mixed"), (std::vector<Face>{{4, 5, 6, 7}}));
  EXPECT_THAT(report.lost, testing::Contains(HasSubstr("*SURFACE, NAME=mixed (line 34 and 1 more)")));
}

TEST_F(Inp, takes_a_blank_label_of_a_surface_as_all_free_sides) {
  EXPECT_THAT(read(kCube + "*Surface, name=all\n body,\n").face_sets.at("all"), testing::SizeIs(6));
  EXPECT_THAT(read(kCube + "*Surface, name=all\n 5\n").face_sets.at("all"), testing::SizeIs(6));
}

TEST_F(Inp, takes_coordinates_that_are_missing_at_the_end_as_0) {
  EXPECT_EQ(read(replaced(kCube, " 11, 1., 0., 0.", " 11, 1.")).X.col(1), Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(read(replaced(kCube, " 13, 0, 1, 0", " 13, , 1,")).X.col(3), Eigen::Vector3d(0, 1, 0));
}

// By the divergence theorem, from plane faces that point outward.
double volume_within(const Mesh& mesh, const std::vector<Face>& faces) {
  double volume = 0;
  for (const Face& f : faces)
    for (int k : {1, 2})
      volume += mesh.X.col(f[0]).dot(
                    Eigen::Vector3d(mesh.X.col(f[k])).cross(Eigen::Vector3d(mesh.X.col(f[k + 1])))) /
                6;
  return volume;
}

// Of the cube: a wedge, a pyramid and a tetrahedron as hexahedra with repeated nodes, with a surface of all
// six sides.
TEST_F(Inp, reads_collapsed_hexahedra_as_the_cells_that_they_are) {
  const auto collapsed = [&](const std::string& nodes) {
    return replaced(replaced(kCube, " 5, 10, 11, 12, 13,\n 20, 21, 22, 23", " 5, " + nodes),
                    " body, S1\n 5, s6", " 5, S1\n 5, S2\n 5, S3\n 5, S4\n 5, S5\n 5, S6");
  };
  struct Collapsed {
    std::string nodes;
    CellType type;
    double volume;
  };
  const Collapsed all[] = {{"10, 11, 12, 12, 20, 21, 22, 22", CellType::wedge6, 0.5},
                           {"10, 11, 12, 13, 20, 20, 23, 23", CellType::wedge6, 0.5},
                           {"10, 10, 11, 12, 20, 20, 21, 22", CellType::wedge6, 0.5},
                           {"10, 11, 12, 13, 20, 20, 20, 20", CellType::pyramid5, 1. / 3},
                           {"10, 11, 13, 13, 20, 20, 20, 20", CellType::tet4, 1. / 6}};
  for (const Collapsed& c : all) {
    ReadReport report;
    const Mesh mesh = read(collapsed(c.nodes), &report);
    ASSERT_EQ(mesh.cells.type.at(0), c.type) << c.nodes;
    EXPECT_NEAR(volume_within(mesh, mesh.face_sets.at("skin")), c.volume, 1e-14) << c.nodes;
    EXPECT_GT(smallest_jacobian(mesh, 0), 0) << c.nodes;
    EXPECT_THAT(mesh.face_sets.at("skin"),
                testing::UnorderedElementsAreArray(cell_faces(c.type, mesh.cells[0])));
    EXPECT_THAT(report.read_as.front(), HasSubstr("C3D8 (line 15): elements that repeat nodes are read as "));
  }
  EXPECT_THAT(error_of(collapsed("10, 11, 10, 13, 20, 21, 22, 23")),
              HasSubstr("line 15: element 5 repeats nodes, its 7 different"));
}

TEST(Collapsed, keeps_the_midside_nodes_of_the_edges_that_are_left) {
  const auto middle = [](Tag a, Tag b) { return a == b ? a : 100 * std::min(a, b) + std::max(a, b); };
  for (const auto& corners : {std::array<Tag, 8>{1, 2, 3, 3, 5, 6, 7, 7}, {1, 2, 3, 3, 5, 5, 5, 5}}) {
    std::vector<Tag> nodes(corners.begin(), corners.end());
    for (const auto& [a, b] : edges(CellType::hex20)) nodes.push_back(middle(corners[a], corners[b]));
    const auto cell = without_repeated_nodes(CellType::hex20, nodes);
    ASSERT_TRUE(cell);
    EXPECT_EQ(cell->type, corners[5] == 6 ? CellType::wedge15 : CellType::tet10);
    for (std::size_t e = 0; e < edges(cell->type).size(); ++e) {
      const auto [a, b] = edges(cell->type)[e];
      EXPECT_EQ(cell->nodes[static_cast<std::size_t>(corner_count(cell->type)) + e],
                middle(cell->nodes[a], cell->nodes[b]));
    }
  }
}

TEST_F(Inp, tells_that_the_last_line_may_be_cut) {
  ReadReport report;
  read(kCube.substr(0, kCube.size() - 1), &report);
  EXPECT_THAT(report.lost.front(), HasSubstr("truncated?"));
}

TEST_F(Inp, names_line_and_value_of_hostile_input) {
  EXPECT_THAT(error(" 11, 1., 0., 0.", " 11, nan, 0., 0."), HasSubstr("line 6: a coordinate is nan"));
  EXPECT_THAT(error(" 11, 1., 0., 0.", " 11, 1e999, 0., 0."), HasSubstr("a coordinate is '1e999'"));
  EXPECT_THAT(error(" 11, 1., 0., 0.", " 12, 1., 0., 0."), HasSubstr("node 12 is defined twice"));
  EXPECT_THAT(error(" 11, 1., 0., 0.", " -11, 1., 0., 0."), HasSubstr("node number -11"));
  EXPECT_THAT(error("20, 21, 22, 23", "20, 21, 22, 24"), HasSubstr("element 5 names node 24"));
  EXPECT_THAT(error("20, 21, 22, 23", "20, 21, 22"), HasSubstr("has 7 nodes"));
  EXPECT_THAT(error("20, 21, 22, 23", "20, 21, 22, 23, 24"), HasSubstr("has 9 nodes"));
  EXPECT_THAT(error("C3D8R", "C3D27"), HasSubstr("element type 'C3D27'"));
  EXPECT_THAT(error("C3D8R", "C3D10"), HasSubstr("its type needs 10"));
  EXPECT_THAT(error("Bottom, 23", "Bottom, 24"), HasSubstr("line 18: node set 'Mixed' names node 24"));
  EXPECT_THAT(error("Bottom, 23", "Bottum, 23"), HasSubstr("line 18: unknown node set 'BOTTUM'"));
  EXPECT_THAT(error("Bottom, 23", "Mixed"), HasSubstr("contains itself"));
  EXPECT_THAT(error(" 10, 13, 1", " 10, 2000000000000, 1"),
              HasSubstr("line 20: node set 'bottom' names node 14"));
  EXPECT_THAT(error(" 10, 13, 1", " 10, 13, 0"), HasSubstr("step of a range is 0"));
  EXPECT_THAT(error("5, s6", "5, s7"), HasSubstr("names side S7 of a hex8, which has S1..S6"));
  EXPECT_THAT(error("5, s6", "6, s6"), HasSubstr("names element 6"));
  EXPECT_THAT(error("body, S1", "corpus, S1"), HasSubstr("unknown element set 'corpus'"));
  EXPECT_THAT(error("*Heading", "1, 2"), HasSubstr("line 1: data before the first keyword"));
}

// One tetrahedron, whose second-order element takes two lines.
const std::string kTetrahedron = R"(*Node
 1, 0., 0., 0.
 2, 2., 0., 0.
 3, 0., 2., 0.
 4, 0., 0., 2.
 5, 1., 0., 0.
 6, 1., 1., 0.
 7, 0., 1., 0.
 8, 0., 0., 1.
 9, 1., 0., 1.
 10, 0., 1., 1.
*Element, type=C3D10
 1, 1, 2, 3, 4,
 5, 6, 7, 8, 9, 10
*Surface, name=skin
 1, S3
)";

TEST_F(Inp, cuts_a_side_with_midside_nodes_into_faces_that_use_them_all) {
  const Mesh mesh = read(kTetrahedron);
  EXPECT_EQ(mesh.face_sets.at("skin"),
            (std::vector<Face>{{1, 5, 8, 8}, {2, 9, 5, 5}, {3, 8, 9, 9}, {5, 9, 8, 8}}));
}

TEST_F(Inp, refuses_sides_that_a_cell_does_not_have_and_parts_of_sides) {
  try {
    read(replaced(kTetrahedron, "1, S3", "1, S5"));
    FAIL();
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("line 16: surface 'skin' names side S5 of a tet10, which has S1..S4"));
  }
  Mesh mesh = read(kTetrahedron);
  mesh.face_sets.at("skin").pop_back();
  EXPECT_THROW(write_inp(path, mesh), Error);
}

TEST_F(Inp, refuses_names_that_the_format_confuses) {
  Mesh mesh = box_mesh({1, 1, 1});
  mesh.node_sets["seat"] = {0};
  mesh.node_sets["SEAT"] = {1};
  EXPECT_THROW(write_inp(path, mesh), Error);
  mesh.node_sets.erase("SEAT");
  mesh.node_sets["a,b"] = {1};
  EXPECT_THROW(write_inp(path, mesh), Error);
}

}  // namespace
}  // namespace elastogear::inp_test
