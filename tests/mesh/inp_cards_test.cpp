// Materials, restraint, included files and parts in .inp files.
#include "mesh/inp/inp_variant.h"
#include "mesh/inp/lines/inp.h"
#include "reader_test.h"

namespace elastogear::inp_cards_test {
using namespace mesh;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

namespace {

constexpr double kRoundoff = 1e-14;
constexpr double kMillimetre = 1e-3;

const std::string kDeck = R"(*NODE, NSET=ALL
 1, 0., 0., 0.
 2, 1., 0., 0.
 3, 0., 1., 0.
 4, 0., 0., 1.
*ELEMENT, TYPE=C3D4, ELSET=Body
 7, 1, 2, 3, 4
*NSET, NSET=FIX
 1, 2
*MATERIAL, NAME=Steel
*ELASTIC
 210000., 0.3, 20.
*DENSITY
 7.85D-9,
*MATERIAL, NAME=FIBRE
*ELASTIC, TYPE=ENGINEERING CONSTANTS
 140000., 9000., 8000., 0.3, 0.25, 0.4, 5000., 4000.,
 3000., 293.
*DENSITY
 1.6E-9
*ORIENTATION, NAME=WOUND, SYSTEM=CYLINDRICAL
 2., 0., 0., 2., 0., 3.
 1, 30.
*SOLID  SECTION, ELSET=BODY, MATERIAL=STEEL
 ,
*BOUNDARY
 FIX, 1, 3
 3, 1, 3, 0.
*STEP
*FREQUENCY
 5
*END STEP
)";

struct InpCards : ReaderTest {
  InpCards() : ReaderTest("deck.inp", kDeck) {}

  ReadReport report_of(const std::string& content, double unit_in_m = 1) const {
    write_file(path, content);
    ReadReport report;
    read_inp(path, unit_in_m, &report);
    return report;
  }
  ReadReport report_with(const std::string& from, const std::string& to) const {
    return report_of(replaced(sample, from, to));
  }
};

TEST_F(InpCards, give_a_section_its_material_in_si_units) {
  const auto regions = report_of(kDeck, kMillimetre).regions;
  ASSERT_EQ(regions.size(), 1u);
  EXPECT_EQ(regions[0].cell_set, "Body");
  EXPECT_NEAR(regions[0].material.E / 210e9, 1, kRoundoff);
  EXPECT_EQ(regions[0].material.nu, 0.3);
  EXPECT_NEAR(regions[0].material.rho / 7850, 1, kRoundoff);
  EXPECT_FALSE(regions[0].material.orthotropic);
  EXPECT_EQ(report_of(kDeck).regions[0].material.E, 210000);
}

TEST_F(InpCards, read_engineering_constants_and_orientations) {
  const auto wound = replaced(kDeck, "MATERIAL=STEEL", "MATERIAL=Fibre, ORIENTATION=Wound");
  const auto regions = report_of(wound, kMillimetre).regions;
  ASSERT_TRUE(regions.at(0).material.orthotropic);
  const model::Orthotropic& m = *regions[0].material.orthotropic;
  EXPECT_LT((m.E - 1e9 * Eigen::Vector3d(140, 9, 8)).norm(), kRoundoff * 140e9);
  EXPECT_EQ(m.nu, Eigen::Vector3d(0.3, 0.25, 0.4));
  EXPECT_LT((m.G - 1e9 * Eigen::Vector3d(5, 4, 3)).norm(), kRoundoff * 5e9);
  EXPECT_EQ(m.orientation.system, model::Orientation::System::cylindrical);
  EXPECT_EQ(m.orientation.origin, Eigen::Vector3d(0.002, 0, 0));
  EXPECT_EQ(m.orientation.axis, Eigen::Vector3d(0, 0, 3));
  EXPECT_LT((m.orientation.rotation - Eigen::Vector3d(M_PI / 6, 0, 0)).norm(), kRoundoff);
}

TEST_F(InpCards, turn_an_orthotropic_stiffness_into_engineering_constants) {
  // Isotropic: E = 2.5, nu = 0.25 have lambda = mu = 1.
  const auto deck = replaced(kDeck, "*ELASTIC\n 210000., 0.3, 20.",
                             "*ELASTIC, TYPE=ORTHO\n 3., 1., 3., 1., 1., 3., 1., 2.,\n 4.");
  const auto report = report_of(deck);
  ASSERT_TRUE(report.regions.at(0).material.orthotropic);
  const model::Orthotropic& m = *report.regions[0].material.orthotropic;
  EXPECT_LT((m.E - Eigen::Vector3d::Constant(2.5)).norm(), 10 * kRoundoff);
  EXPECT_LT((m.nu - Eigen::Vector3d::Constant(0.25)).norm(), 10 * kRoundoff);
  EXPECT_EQ(m.G, Eigen::Vector3d(1, 2, 4));
}

TEST_F(InpCards, make_a_node_set_of_what_boundary_holds) {
  const Mesh mesh = read(kDeck);
  EXPECT_THAT(mesh.node_sets.at("BOUNDARY"), ElementsAre(0, 1, 2));
  EXPECT_THAT(report_of(kDeck).restrained, ElementsAre("BOUNDARY"));
  const auto taken = replaced(replaced(kDeck, "NSET=FIX", "NSET=BOUNDARY"), " FIX, 1, 3", " BOUNDARY, 1, 3");
  EXPECT_THAT(report_of(taken).restrained, ElementsAre("BOUNDARY_"));
  const ReadReport split = report_with(" FIX, 1, 3", " FIX, 1, 2\n FIX, ZSYMM");
  EXPECT_THAT(split.restrained, ElementsAre("BOUNDARY")) << "directions add up over lines";
}

TEST_F(InpCards, make_a_node_set_of_each_combination_of_directions) {
  const auto deck = replaced(kDeck, " FIX, 1, 3", " 1, 2, 3\n 2, XASYMM\n 4, ZSYMM");
  const Mesh mesh = read(deck);
  EXPECT_THAT(report_of(deck).restrained, ElementsAre("BOUNDARY", "BOUNDARY_yz:yz", "BOUNDARY_z:z"));
  EXPECT_THAT(mesh.node_sets.at("BOUNDARY"), ElementsAre(2));
  EXPECT_THAT(mesh.node_sets.at("BOUNDARY_yz"), ElementsAre(0, 1));
  EXPECT_THAT(mesh.node_sets.at("BOUNDARY_z"), ElementsAre(3));
}

TEST_F(InpCards, say_which_element_types_are_computed_otherwise) {
  EXPECT_THAT(report_of(kDeck).read_as, IsEmpty());
  const auto note = [&](const std::string& type) {
    const auto notes = report_with("TYPE=C3D4", "TYPE=" + type).read_as;
    return notes.size() == 1 ? notes[0] : "";
  };
  EXPECT_EQ(note("C3D4H"), "C3D4H (line 6): read as C3D4; not reproduced: its hybrid formulation");
  EXPECT_EQ(variant_note("C3D20R", CellType::hex20), "read as C3D20; not reproduced: reduced integration");
  EXPECT_THAT(variant_note("C3D10MT", CellType::tet10),
              HasSubstr("not reproduced: its modified formulation and temperature"));
  EXPECT_THAT(variant_note("C3D8R", CellType::hex8),
              AllOf(HasSubstr("not reproduced: reduced integration; "), HasSubstr("option element says")));
  EXPECT_THAT(variant_note("C3D8", CellType::hex8),
              testing::StartsWith("computed as the option element says"));
  EXPECT_EQ(variant_note("C3D8I", CellType::hex8), "");
  EXPECT_EQ(variant_note("C3D20", CellType::hex20), "");
  const auto twice =
      replaced(kDeck, "*NSET, NSET=FIX",
               "*ELEMENT, TYPE=C3D4H\n 8, 1, 2, 3, 4\n*ELEMENT, TYPE=C3D4H\n 9, 1, 2, 3, 4\n*NSET, NSET=FIX");
  EXPECT_THAT(report_of(twice).read_as, ElementsAre(HasSubstr("C3D4H (line 8)")));
}

TEST_F(InpCards, name_all_they_leave_out) {
  EXPECT_THAT(report_of(kDeck).ignored,
              ElementsAre("*STEP (line 29)", "*FREQUENCY (line 30)", "*END STEP (line 32)"));
  EXPECT_THAT(report_of(kDeck).lost, IsEmpty());
  EXPECT_THAT(report_with("0.3, 20.", "0.3, 20.\n 200000., 0.3, 200.").lost.front(),
              HasSubstr("*ELASTIC (line 11): of its table only the first row"));
  EXPECT_THAT(report_with("*ELASTIC\n", "*ELASTIC, TYPE=ANISO\n").lost.front(),
              HasSubstr("TYPE=ANISO (line 11)"));
  EXPECT_THAT(report_with("3, 0.\n", "3, 0.5\n").lost.front(),
              HasSubstr("(line 28): nodes with a displacement other than 0 are held where they are"));
  EXPECT_THAT(report_with("*BOUNDARY", "*BOUNDARY, TYPE=VELOCITY").lost.front(), HasSubstr("TYPE=VELOCITY"));
  EXPECT_THAT(report_with("*DENSITY", "*EXPANSION\n 1e-5\n*DENSITY").ignored.front(), "*EXPANSION (line 13)");
}

TEST_F(InpCards, say_once_what_keywords_that_are_not_read_would_change) {
  const auto lost = [&](const std::string& cards) {
    return report_with("*BOUNDARY", cards + "*BOUNDARY").lost;
  };
  EXPECT_THAT(lost("*SPRING, ELSET=A\n 1\n*SPRING, ELSET=B\n 1\n"),
              ElementsAre("*SPRING (line 26 and 1 more): springs, dampers and connectors are left out"));
  EXPECT_THAT(lost("*TIE, NAME=T\n A, B\n"), ElementsAre(HasSubstr("merge the nodes there")));
  EXPECT_THAT(lost("*SPRUNG\n 1, 2\n"),
              ElementsAre(HasSubstr("*SPRUNG (line 26): a keyword that is not known")));
  EXPECT_THAT(lost("*NSET, NSET=A, SORTED\n 1\n"),
              ElementsAre("*NSET, SORTED (line 26): this parameter is not read"));
  EXPECT_THAT(error("*BOUNDARY", "*NODE, OFFSET=4\n 9, 1.\n*BOUNDARY"),
              HasSubstr("line 26: *NODE with the parameter OFFSET is not supported, read are: NSET, INPUT"));
  EXPECT_THAT(error("*BOUNDARY", "*NCOPY, OLD SET=A\n*BOUNDARY"),
              HasSubstr("line 26: *NCOPY: it makes nodes"));
}

TEST_F(InpCards, read_keywords_without_blanks_and_parameters_cut_short) {
  EXPECT_EQ(report_with("*SOLID  SECTION", "*solidsection").regions.size(), 1u);
  const Mesh mesh = read(replaced(kDeck, "*BOUNDARY", "*NSET, NSET=RANGE, GEN\n 1, 3\n*BOUNDARY"));
  EXPECT_THAT(mesh.node_sets.at("RANGE"), ElementsAre(0, 1, 2));
}

TEST_F(InpCards, end_a_keyword_line_by_a_comma_above_data) {
  EXPECT_THAT(read(replaced(kDeck, "NSET=FIX", "NSET=FIX,")).node_sets.at("FIX"), ElementsAre(0, 1));
  EXPECT_THAT(read(replaced(kDeck, "*NSET, NSET=FIX", "*NSET,\n NSET=FIX,\n INTERNAL")).node_sets.at("FIX"),
              ElementsAre(0, 1));
  EXPECT_EQ(report_with("*MATERIAL, NAME=Steel", "*MATERIAL, NAME=Steel,").regions.size(), 1u);
}

TEST_F(InpCards, may_have_names_with_commas_and_in_any_encoding) {
  const auto sets = [&](const std::string& name) {
    return read(replaced(kDeck, "NSET=FIX\n", "NSET=" + name + "\n FIX\n*NSET, NSET=FIX\n")).node_sets;
  };
  EXPECT_TRUE(sets("\"bore, left\"").contains("bore, left"));
  EXPECT_TRUE(sets("\xC3\x9C"
                   "bung")
                  .contains("\xC3\x9C"
                            "bung"));
  EXPECT_TRUE(sets("\xDC"
                   "bung")
                  .contains("\xC3\x9C"
                            "bung"))
      << "Latin-1";
  EXPECT_EQ(read("\xEF\xBB\xBF" + kDeck).n_nodes(), 4);
}

TEST_F(InpCards, read_the_restraint_of_the_first_step_alone) {
  const auto held = [&](const std::string& first, const std::string& second) {
    const auto report = report_with("*FREQUENCY", first + "*FREQUENCY");
    const auto both =
        replaced(kDeck, "*FREQUENCY", first + "*FREQUENCY") + "*STEP\n" + second + "*END STEP\n";
    EXPECT_EQ(report_of(both).restrained, report.restrained);
    EXPECT_THAT(report_of(both).lost, ElementsAre(HasSubstr("*BOUNDARY of a later step (line ")));
    return report.restrained;
  };
  EXPECT_THAT(held("*BOUNDARY\n 4, 2\n", "*BOUNDARY\n 4, 3\n"), ElementsAre("BOUNDARY", "BOUNDARY_y:y"));
  EXPECT_THAT(held("*BOUNDARY, OP=NEW\n 4, 2\n*BOUNDARY, OP=NEW\n 4, 3\n", "*BOUNDARY\n 4, 1\n"),
              ElementsAre("BOUNDARY_yz:yz"))
      << "OP=NEW takes back what stands above the step";
}

TEST_F(InpCards, turn_the_axes_of_held_nodes_where_they_are_those_of_the_mesh) {
  const auto held = [&](const std::string& transform, const std::string& boundary) {
    return replaced(replaced(kDeck, " FIX, 1, 3\n 3, 1, 3, 0.\n", boundary), "*BOUNDARY",
                    "*TRANSFORM, NSET=FIX, " + transform + "\n*BOUNDARY");
  };
  EXPECT_THAT(report_of(held("TYPE=R\n 0., 1., 0., -1., 0., 0.", " FIX, 1\n")).restrained,
              ElementsAre("BOUNDARY_y:y"));
  EXPECT_THAT(report_of(held("TYPE=C\n 0., 1., 0., 1., 1., 0.", " FIX, 3\n")).restrained,
              ElementsAre("BOUNDARY_x:x"));
  EXPECT_THAT(report_of(held("TYPE=C\n 0., 1., 0., 0., 1., 5.", " FIX, 1, 2\n")).restrained,
              ElementsAre("BOUNDARY_xy:xy"));
  EXPECT_THAT(report_of(held("TYPE=C\n 0., 1., 0., 0., 1., 5.", " FIX, 1, 3\n")).restrained,
              ElementsAre("BOUNDARY"));
  EXPECT_THAT(error_of(held("TYPE=C\n 0., 1., 0., 0., 1., 5.", " FIX, 1\n")),
              HasSubstr("line 26: *TRANSFORM: node 2 is held along cylindrical axes"));
  EXPECT_THAT(error_of(held("TYPE=S\n 0., 0., 0., 0., 1., 5.", " FIX, 1\n")), HasSubstr("TYPE=S"));
  EXPECT_THAT(error_of(held("TYPE=R\n 0., 0., 0., 0., 1., 5.", " FIX, 1\n")), HasSubstr("no directions"));
  EXPECT_THAT(error_of(replaced(held("TYPE=R\n 1., 0., 0.,", " FIX, 1\n"), "NSET=FIX, T", "NSET=FLEX, T")),
              HasSubstr("no directions"));
}

TEST_F(InpCards, read_point_masses_in_the_file_s_units) {
  const std::string masses = "*ELEMENT, TYPE=MASS, ELSET=A\n 90, 1\n 91, 2\n 92, 2\n*MASS, ELSET=A\n 2.E-3\n";
  const ReadReport report = report_of(replaced(kDeck, "*BOUNDARY", masses + "*BOUNDARY"), kMillimetre);
  ASSERT_THAT(report.point_mass, testing::SizeIs(2));
  EXPECT_NEAR(report.point_mass.at("MASS"), 2, kRoundoff * 2) << "t to kg";
  EXPECT_NEAR(report.point_mass.at("MASS_"), 4, kRoundoff * 4) << "two elements on a node";
  const Mesh mesh = read(replaced(kDeck, "*BOUNDARY", masses + "*BOUNDARY"));
  EXPECT_THAT(mesh.node_sets.at("MASS"), ElementsAre(0));
  EXPECT_THAT(mesh.node_sets.at("MASS_"), ElementsAre(1));
  EXPECT_THAT(report.lost, IsEmpty());
  EXPECT_THAT(error("*BOUNDARY", masses + "*MASS, ELSET=B\n 1\n*BOUNDARY"),
              HasSubstr("unknown element set 'B'"));
  EXPECT_THAT(error("*BOUNDARY", "*MASS, ELSET=BODY\n -1\n*BOUNDARY"), HasSubstr("negative"));
}

TEST_F(InpCards, generate_rows_of_nodes_and_elements) {
  const std::string deck =
      "*NODE\n 1, 0.\n 5, 4.\n 11, 0., 1.\n 15, 4., 1.\n 101, 0., 0., 1.\n 105, 4., 0., 1.\n"
      " 111, 0., 1., 1.\n 115, 4., 1., 1.\n*NGEN, NSET=ROW\n 1, 5\n 15, 11, 1\n 101, 105, 2\n 102, 101,\n"
      " 103, 105, 1\n 111, 115\n*ELEMENT, TYPE=C3D8\n 1, 1, 2, 12, 11, 101, 102, 112, 111\n"
      "*ELGEN, ELSET=BAR\n 1, 4, 1, 10\n";
  EXPECT_THAT(error_of(deck), HasSubstr("line 14: node 102 is not defined above"));
  const Mesh mesh =
      read(replaced(replaced(deck, " 102, 101,\n", ""), " 101, 105, 2\n 103, 105, 1", " 101, 105"));
  EXPECT_THAT(mesh.node_sets.at("ROW"), testing::SizeIs(20));
  EXPECT_EQ(mesh.X.col(1), Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(mesh.X.col(8), Eigen::Vector3d(3, 1, 0));
  EXPECT_THAT(mesh.cell_sets.at("BAR"), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(mesh.cells[3], ElementsAre(3, 4, 9, 8, 13, 14, 19, 18));
  EXPECT_THAT(error_of(replaced(deck, " 1, 5\n", " 1, 5, 3\n")),
              HasSubstr("in steps of 3 does not end there"));
  EXPECT_THAT(error_of(replaced(deck, " 1, 5\n", " 1, 900000000000\n")),
              HasSubstr("node 900000000000 is not"));
}

TEST_F(InpCards, generate_no_numbers_beyond_64_bits_and_no_more_than_a_mesh_has) {
  const std::string deck =
      "*NODE\n 1\n 2, 1\n 3, 0, 1\n 4, 0, 0, 1\n 900000000, 9\n*NGEN\n 1, 2\n*ELEMENT, TYPE=C3D4\n 1, 1, 2, "
      "3, 4\n"
      "*ELGEN\n 1, 1\n";
  EXPECT_NO_THROW(read(deck));
  const auto of_nodes = [&](const std::string& line) { return error_of(replaced(deck, " 1, 2\n", line)); };
  const auto of_elements = [&](const std::string& line) { return error_of(replaced(deck, " 1, 1\n", line)); };
  const std::string largest = "9223372036854775807", smallest = "-9223372036854775808";
  EXPECT_THAT(of_nodes(" " + largest + ", " + smallest + "\n"),
              HasSubstr("line 8: the number 9223372036854775807 is beyond 1000000000000000"));
  EXPECT_THAT(of_nodes(" 1, 2, " + smallest + "\n"), HasSubstr("line 8: the number -9223372036854775808"));
  EXPECT_THAT(of_nodes(" 1, 900000000\n"), HasSubstr("line 8: *NGEN of 899999999 x 1 x 1"));
  EXPECT_THAT(of_elements(" 1, 2, " + largest + "\n"), HasSubstr("line 12: the number 9223372036854775807"));
  EXPECT_THAT(of_elements(" 1, 19999, 1000000000000000\n"), HasSubstr("reaches numbers beyond 64 bits"));
  EXPECT_THAT(of_elements(" 1, 3000, 1, 1, 3000, 1, 1, 3000, 1, 1\n"),
              HasSubstr("*ELGEN of 3000 x 3000 x 3000, where *NGEN and *ELGEN may make"));
  InpText few{"deck.inp", replaced(deck, " 1, 1\n", " 1, 6, 0, 1\n 2, 6, 0, 1\n")};
  few.most_generated = 12;
  EXPECT_THROW(parse_inp(few), Error);
  few.most_generated = 13;
  EXPECT_THROW(parse_inp(few), Error);  // elements 3 to 6 are defined twice
  few.content = replaced(deck, " 1, 1\n", " 1, 6, 0, 1\n 6, 6, 0, 1\n");
  EXPECT_EQ(parse_inp(few).cells.size(), 11);
  EXPECT_THAT(
      error_of(replaced(deck, "*NGEN", "*NSET, NSET=A, GENERATE\n " + smallest + ", " + largest + "\n*NGEN")),
      HasSubstr("names node -9223372036854775808, which the file does not define"));
}

TEST_F(InpCards, name_line_and_value_of_hostile_input) {
  EXPECT_THAT(error(" 210000., 0.3, 20.", " 210000."),
              HasSubstr("line 11: *ELASTIC needs 2 numbers, found 1"));
  EXPECT_THAT(error(" 210000., 0.3, 20.\n", ""), HasSubstr("*ELASTIC needs 2 numbers, found 0"));
  EXPECT_THAT(error(" 3000., 293.\n", ""), HasSubstr("line 16: *ELASTIC needs 9 numbers, found 8"));
  EXPECT_THAT(error("210000.", "nan"), HasSubstr("line 12: a material constant is nan"));
  EXPECT_THAT(error("210000.", "steel"), HasSubstr("a material constant is 'steel'"));
  EXPECT_THAT(error("210000.", "-1"), HasSubstr("line 12: Young's modulus is -1"));
  EXPECT_THAT(error("7.85D-9", "-7.85D-9"), HasSubstr("line 14: the density is -7.85e-09"));
  EXPECT_THAT(error("7.85D-9", "inf"), HasSubstr("a material constant is inf"));
  EXPECT_THAT(error("*MATERIAL, NAME=Steel\n", ""), HasSubstr("line 10: *ELASTIC outside a *MATERIAL"));
  EXPECT_THAT(error("*MATERIAL, NAME=Steel", "*MATERIAL"), HasSubstr("without NAME"));
  EXPECT_THAT(error("NAME=FIBRE", "NAME=STEEL"), HasSubstr("material STEEL is defined twice"));
  EXPECT_THAT(error("MATERIAL=STEEL", "MATERIAL=BRASS"),
              HasSubstr("line 24: *SOLID SECTION of 'BODY' names the unknown material 'BRASS'"));
  EXPECT_THAT(error("MATERIAL=STEEL", "MATERIAL=STEEL, ORIENTATION=X"), HasSubstr("unknown orientation 'X'"));
  EXPECT_THAT(error("ELSET=BODY, M", "ELSET=RIM, M"), HasSubstr("unknown element set 'RIM'"));
  EXPECT_THAT(error("ELSET=BODY, M", "M"), HasSubstr("without ELSET="));
  EXPECT_THAT(error("2., 0., 0., 2., 0., 3.", "2., 0., 0., 2., 0., 0."), HasSubstr("give no directions"));
  EXPECT_THAT(error("2., 0., 0., 2., 0., 3.", "2., 0., 0., 2., 0."), HasSubstr("found 5 numbers"));
  EXPECT_THAT(error(" 1, 30.", " 4, 30."), HasSubstr("turns about axis 4"));
  EXPECT_THAT(error("SYSTEM=CYLINDRICAL", "SYSTEM=SPHERICAL"), HasSubstr("SYSTEM=SPHERICAL"));
  EXPECT_THAT(error(" FIX, 1, 3", " FIXED, 1, 3"),
              HasSubstr("line 27: *BOUNDARY names the unknown node or node set 'FIXED'"));
  EXPECT_THAT(error(" 3, 1, 3, 0.", " 9, 1, 3"), HasSubstr("unknown node or node set '9'"));
  EXPECT_THAT(error(" 3, 1, 3, 0.", " 3, 3, 1"), HasSubstr("from degree of freedom 3 to 1"));
  EXPECT_THAT(error(" 3, 1, 3, 0.", " 3"), HasSubstr("line 28: *BOUNDARY needs"));
  EXPECT_THAT(error(" 3, 1, 3, 0.", " 3, 1, 3, nan"), HasSubstr("a displacement is nan"));
  EXPECT_THAT(error("*MATERIAL", "*SYSTEM\n 0,0,1\n*MATERIAL"),
              HasSubstr("*SYSTEM: only global coordinates are read"));
}

TEST_F(InpCards, of_an_impossible_stiffness_are_an_error) {
  EXPECT_THAT(
      error("*ELASTIC\n 210000., 0.3, 20.", "*ELASTIC, TYPE=ORTHO\n 1., 2., 1., 1., 1., 3., 1., 1.,\n 1."),
      HasSubstr("not positive definite"));
}

struct InpInclude : ReaderTest {
  InpInclude()
      : ReaderTest("main.inp",
                   "*NODE\n*INCLUDE, INPUT=parts/nodes.txt\n*ELEMENT, TYPE=C3D4\n 1, 1, 2, 3, 4\n") {
    std::filesystem::create_directories(folder.path / "parts");
    write_file(folder / "parts/nodes.txt", "1, 0, 0, 0\n*include, input=rest.txt\n 3, 0, 1, 0\n");
    write_file(folder / "parts/rest.txt", "2, 1, 0, 0\n4, 0, 0, 1\n");
  }
};

TEST_F(InpInclude, stands_for_the_content_of_a_file_beside_the_one_that_names_it) {
  const Mesh mesh = read(sample);
  EXPECT_EQ(mesh.X.col(1), Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(mesh.X.col(2), Eigen::Vector3d(0, 1, 0));
  EXPECT_EQ(mesh.X.col(3), Eigen::Vector3d(0, 0, 1));
}

TEST_F(InpInclude, names_the_file_and_line_of_an_error) {
  write_file(folder / "parts/rest.txt", "2, 1, 0, 0\n4, 0, 0, nan\n");
  EXPECT_THAT(error_of(sample), HasSubstr("parts/rest.txt, line 2: a coordinate is nan"));
  write_file(folder / "parts/rest.txt", "2, 1, 0, 0\n4, 0, 0, 1\n");
  write_file(folder / "parts/nodes.txt", "1, 0, 0, 0\n*include, input=rest.txt\n 3, 0, one, 0\n");
  EXPECT_THAT(error_of(sample), HasSubstr("parts/nodes.txt, line 3: a coordinate is 'one'"));
  EXPECT_THAT(error("2, 3, 4", "2, 3, x"), HasSubstr("nodes.txt, line 3"));
  write_file(folder / "parts/nodes.txt", "1, 0, 0, 0\n*include, input=rest.txt\n 3, 0, 1, 0\n");
  EXPECT_THAT(error("2, 3, 4", "2, 3, x"), HasSubstr("main.inp, line 4: an element or node number is 'x'"));
}

TEST_F(InpInclude, of_a_file_that_is_missing_or_open_is_an_error) {
  EXPECT_THAT(error("nodes.txt", "none.txt"), HasSubstr("main.inp, line 2: *INCLUDE: "));
  EXPECT_THAT(error(", INPUT=parts/nodes.txt", ""), HasSubstr("*INCLUDE without INPUT=file"));
  EXPECT_THAT(error("parts/nodes.txt", "main.inp"), HasSubstr("main.inp, which is read already"));
  write_file(folder / "parts/rest.txt", "*INCLUDE, INPUT=../parts/nodes.txt\n");
  EXPECT_THAT(error_of(sample), HasSubstr("rest.txt, line 1: *INCLUDE of "));
}

TEST_F(InpInclude, goes_ten_files_deep) {
  for (int i = 0; i < 12; ++i)
    write_file(folder / ("parts/" + std::to_string(i)), "*INCLUDE, INPUT=" + std::to_string(i + 1) + "\n");
  EXPECT_THAT(error("nodes.txt", "0"), HasSubstr("more than 10 deep"));
  write_file(folder / "parts/9", "*INCLUDE, INPUT=rest.txt\n1, 0, 0, 0\n3, 0, 1, 0\n");
  EXPECT_THAT(error("nodes.txt", "1"), "no error");
}

// As Abaqus CAE writes a single part.
const std::string kPart = R"(*Heading
*Part, name=Part-1
*Node
 1, 0., 0., 0.
 2, 1., 0., 0.
 3, 0., 1., 0.
 4, 0., 0., 1.
*Element, type=C3D4
 1, 1, 2, 3, 4
*Elset, elset=Set-1, generate
 1, 1, 1
*Solid Section, elset=Set-1, material=Steel
,
*End Part
*Assembly, name=Assembly
*Instance, name=Part-1-1, part=Part-1
*End Instance
*Nset, nset=Fixed, instance=Part-1-1
 1, 2
*Nset, nset=Again
 Part-1-1.4, Fixed
*Elset, elset=_Surf_S1, internal, instance=Part-1-1
 1
*Surface, type=ELEMENT, name=Surf
 _Surf_S1, S1
*End Assembly
*Material, name=Steel
*Density
 7.8e-09,
*Elastic
 210000., 0.3
*Boundary
 Fixed, ENCASTRE
 Part-1-1.3, PINNED
)";

TEST_F(InpInclude, may_be_data_that_a_keyword_names) {
  const std::string deck =
      "*NODE, NSET=ALL, INPUT=parts/rest.txt\n 1, 0, 0, 0\n*NODE, INPUT=more.txt\n"
      "*ELEMENT, TYPE=C3D4, ELSET=BODY, INPUT=cell.txt\n";
  write_file(folder / "more.txt", "3, 0, 1, 0\n");
  write_file(folder / "cell.txt", "7, 1, 2, 3, 4\n");
  const Mesh mesh = read(deck);
  EXPECT_THAT(mesh.node_sets.at("ALL"), ElementsAre(0, 1, 3));
  EXPECT_THAT(mesh.cell_sets.at("BODY"), ElementsAre(0));
  write_file(folder / "cell.txt", "7, 1, 2, 3, x\n");
  EXPECT_THAT(error_of(deck), HasSubstr("cell.txt, line 1: an element or node number is 'x'"));
  EXPECT_THAT(error_of(replaced(deck, "cell.txt", "none.txt")), HasSubstr("main.inp, line 4: *ELEMENT: "));
  EXPECT_THAT(error_of(replaced(deck, "cell.txt\n", "cell.txt,")),
              HasSubstr("line 4: *ELEMENT, INPUT= ends with a comma"));
}

struct InpPart : ReaderTest {
  InpPart() : ReaderTest("part.inp", kPart) {}
};

TEST_F(InpPart, is_read_as_one_body) {
  ReadReport report;
  const Mesh mesh = read(kPart, &report);
  EXPECT_THAT(mesh.node_sets.at("Fixed"), ElementsAre(0, 1));
  EXPECT_THAT(mesh.node_sets.at("Again"), ElementsAre(0, 1, 3));
  EXPECT_THAT(mesh.node_sets.at("BOUNDARY"), ElementsAre(0, 1, 2));
  EXPECT_THAT(mesh.face_sets.at("Surf"), ElementsAre(Face{0, 2, 1, 1}));
  ASSERT_EQ(report.regions.size(), 1u);
  EXPECT_EQ(report.regions[0].cell_set, "Set-1");
  EXPECT_THAT(report.restrained, ElementsAre("BOUNDARY"));
  EXPECT_THAT(report.ignored, ElementsAre("*HEADING (line 1)"));
}

// As Abaqus CAE writes an independent instance: the part is empty, the instance has its content.
std::string independent(const std::string& deck) {
  const std::size_t begin = deck.find("*Node"), end = deck.find("*End Part");
  const std::string content = deck.substr(begin, end - begin);
  return replaced(replaced(deck, content, ""), "*End Instance", content + "*End Instance");
}

TEST_F(InpPart, may_be_the_content_of_an_independent_instance) {
  ReadReport of_part, of_instance;
  const Mesh a = read(kPart, &of_part), b = read(independent(kPart), &of_instance);
  EXPECT_EQ(a.X, b.X);
  EXPECT_EQ(a.cells.nodes, b.cells.nodes);
  EXPECT_EQ(a.node_sets, b.node_sets);
  EXPECT_EQ(a.cell_sets, b.cell_sets);
  EXPECT_EQ(a.face_sets, b.face_sets);
  EXPECT_EQ(of_instance.restrained, of_part.restrained);
  EXPECT_EQ(of_instance.regions.size(), 1u);
  const std::string point =
      replaced(independent(kPart), "*End Assembly", "*Node\n 9, 0., 0., 0.\n*End Assembly");
  EXPECT_THAT(error_of(point), HasSubstr("a reference point?"));
}

// Abaqus Analysis User's Guide, "Defining an assembly": the translation first, then the rotation.
TEST_F(InpPart, stands_where_its_instance_is_placed) {
  const auto placed = [&](const std::string& lines) {
    return read(replaced(kPart, "*End Instance", lines + "*End Instance"));
  };
  EXPECT_EQ(placed(" 1., 0., 2.\n").X.col(1), Eigen::Vector3d(2, 0, 2));
  const Mesh turned = placed(" 1., 0., 0.\n 0., 1., 0., 0., 1., 5., 90.\n");
  EXPECT_LT((turned.X.col(0) - Eigen::Vector3d(1, 2, 0)).norm(), 1e-15);
  EXPECT_LT((turned.X.col(1) - Eigen::Vector3d(1, 3, 0)).norm(), 1e-15);
  EXPECT_LT((turned.X.col(3) - Eigen::Vector3d(1, 2, 1)).norm(), 1e-15);
}

TEST_F(InpPart, must_be_the_only_one_and_in_place) {
  EXPECT_THAT(error("*End Part", "*End Part\n*Part, name=B"), HasSubstr("line 15: a second *PART"));
  EXPECT_THAT(error("*End Instance", "*End Instance\n*Instance, name=B, part=Part-1"),
              HasSubstr("a second *INSTANCE"));
  EXPECT_THAT(error("*End Instance", " 1., 0., 0.\n 1., 2., 3.\n*End Instance"),
              HasSubstr("line 18: a rotation of an *INSTANCE has 3 numbers"));
  const std::string turned =
      replaced(kPart, "*Material", "*Orientation, name=O\n 1., 0., 0., 0., 1., 0.\n*Material");
  EXPECT_THAT(error_of(replaced(turned, "*End Instance", " 1., 0., 0.\n*End Instance")),
              HasSubstr("line 17: an *INSTANCE that is moved"));
  EXPECT_THAT(error("*End Assembly", "*Node\n 1, 0., 0., 0.\n*End Assembly"),
              HasSubstr("a reference point?"));
  EXPECT_THAT(error("elset=_Surf_S1", "elset=Set-1"), HasSubstr("has the name of a set of the part"));
  EXPECT_THAT(error("Part-1-1.4", "Part-2-1.4"), HasSubstr("unknown node set 'PART-2-1.4'"));
}

// Beside the part of kPart one of the same nodes and sets, whose instance stands first.
const std::string kTwoParts = [] {
  std::string deck = kPart;
  const std::size_t begin = deck.find("*Part, name"), end = deck.find("*Assembly");
  const std::string other = replaced(deck.substr(begin, end - begin), "name=Part-1", "name=Part-0");
  deck = replaced(deck, "*Part, name=Part-1", other + "*Part, name=Part-1");
  return replaced(deck, "*Instance, ", "*Instance, name=Part-0-1, part=Part-0\n*End Instance\n*Instance, ");
}();

Mesh instance_of(const std::string& deck) { return parse_inp({"deck.inp", deck, read_file, "part-1-1"}); }

TEST(InpInstances, keep_what_sets_that_span_instances_hold_of_the_chosen_one) {
  const Mesh mesh = instance_of(kTwoParts);
  EXPECT_THAT(mesh.node_sets.at("BOUNDARY"), ElementsAre(0, 1, 2));
  const std::string both =
      "*Nset, nset=BOTH, instance=Part-0-1\n 2\n*Nset, nset=Both, instance=Part-1-1\n 4\n"
      "*Nset, nset=Theirs, instance=Part-0-1\n 1\n*Nset, nset=Set-1, instance=Part-0-1\n 1\n"
      "*Nset, nset=Held\n Both, Theirs, Part-0-1.3\n*Nset, nset=None\n Theirs, Part-0-1.2\n"
      "*Elset, elset=_Both_S2, internal, instance=Part-0-1\n 1\n"
      "*Elset, elset=_Both_S2, internal, instance=Part-1-1\n 1\n"
      "*Elset, elset=_Theirs_S2, internal, instance=Part-0-1\n 1\n"
      "*Surface, name=Both\n _Both_S2, S2\n _Theirs_S2, S2\n*Surface, name=Theirs\n _Theirs_S2, S2\n";
  const std::string deck =
      replaced(replaced(kTwoParts, "*Nset, nset=Fixed", both + "*Nset, nset=Fixed"), " Fixed, ENCASTRE\n",
               " Held, 2\n None, 1\n Theirs, PINNED\n Set-1, PINNED\n Part-0-1.2, PINNED\n");
  const Mesh of_both = instance_of(deck);
  EXPECT_THAT(of_both.node_sets.at("Both"), ElementsAre(3));
  EXPECT_THAT(of_both.node_sets.at("Held"), ElementsAre(3));
  EXPECT_THAT(of_both.node_sets.at("BOUNDARY_y"), ElementsAre(3));
  EXPECT_THAT(of_both.node_sets.at("BOUNDARY"), ElementsAre(2));
  for (const char* name : {"Theirs", "None", "Set-1"}) EXPECT_FALSE(of_both.node_sets.contains(name)) << name;
  EXPECT_THAT(of_both.face_sets.at("Both"), testing::SizeIs(1));
  EXPECT_FALSE(of_both.face_sets.contains("Theirs"));
}

TEST(InpInstances, leave_a_part_the_sets_whose_names_others_have_in_the_assembly) {
  std::string deck = replaced(kTwoParts, "*Nset, nset=Fixed",
                              "*Elset, elset=Set-1, instance=Part-0-1\n 1\n*Nset, nset=Fixed");
  const std::size_t chosen = deck.find("*Part, name=Part-1");
  deck.insert(deck.find("*Solid Section", chosen),
              "*Elset, elset=Whole\n Set-1\n*Surface, name=Side\n Set-1, S3\n");
  const Mesh mesh = instance_of(deck);
  EXPECT_THAT(mesh.cell_sets.at("Whole"), ElementsAre(0));
  EXPECT_THAT(mesh.face_sets.at("Side"), testing::SizeIs(1));
}

TEST(MemberBudget, ends_files_that_would_need_far_more_memory_than_they_have_bytes) {
  std::string deck = kDeck.substr(0, kDeck.find("*MATERIAL"));
  for (int i = 5; i < 3000; ++i) deck += "*NODE\n" + std::to_string(i) + ",0,0,0\n";
  const std::string all = "*NSET, NSET=A, GENERATE\n1, 2999\n";
  EXPECT_NO_THROW(parse_inp({"deck.inp", deck + all}));
  for (int i = 0; i < 2000; ++i) deck += "*NSET, NSET=B" + std::to_string(i) + "\nA\n";
  EXPECT_THROW(parse_inp({"deck.inp", deck + all}), Error);
}

}  // namespace
}  // namespace elastogear::inp_cards_test
