#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "elastogear/io/csv.h"
#include "elastogear/io/describe.h"
#include "elastogear/io/field_file.h"
#include "elastogear/io/polydata_file.h"
#include "elastogear/io/stress_file.h"
#include "elastogear/mesh/file.h"
#include "io/hdf5/hdf5_api.h"
#include "sample_body.h"
#include "sample_result.h"

namespace elastogear::describe_test {
using namespace io;
using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

namespace {

StressFile sample_stress() {
  StressFile history;
  history.time = Eigen::Vector3d(0, 1e-6, 2e-6);
  history.provenance = {{"options", "-a b"}};
  history.sets = {{"worm",
                   "root",
                   {4, 7},
                   Eigen::MatrixXd::Random(12, 3),
                   Eigen::MatrixXd::Random(2, 3),
                   Eigen::MatrixXd::Random(2, 3)},
                  {"worm", "empty", {}, Eigen::MatrixXd(0, 3), Eigen::MatrixXd(0, 3), Eigen::MatrixXd(0, 3)}};
  history.sets[0].von_mises(1, 2) = 123e6;
  history.sets[0].rankine(0, 1) = 98e6;
  return history;
}

struct Describe : testing::Test {
  mesh::Folder folder{"describe"};
  std::string path(const char* name) const { return folder / name; }
};

TEST_F(Describe, mesh_files) {
  for (const char* name : {"box.msh", "box.inp"}) {
    mesh::write_mesh(path(name), mesh::box_mesh_with_sets({2, 1, 1}));
    EXPECT_THAT(describe(path(name)), AllOf(HasSubstr("12 nodes, 2 cells (2 hex8)"), HasSubstr("flank: 10")));
  }
}

TEST_F(Describe, meshes_whose_cells_overlap_or_do_not_hang_together) {
  mesh::Mesh mesh = mesh::box_mesh({2, 1, 1});
  const std::vector<int> last(mesh.cells[1].begin(), mesh.cells[1].end());
  mesh.cells.add(mesh::CellType::hex8, last);
  mesh::write_mesh(path("twice.msh"), mesh);
  EXPECT_THAT(describe(path("twice.msh")), HasSubstr("overlap: cells 2 and 3 fill the same place"));
  mesh = mesh::box_mesh({3, 1, 1});
  mesh.cells.type.erase(mesh.cells.type.begin() + 1);
  mesh.cells.nodes.erase(mesh.cells.nodes.begin() + 8, mesh.cells.nodes.begin() + 16);
  mesh.cells.offset.pop_back();
  mesh::write_mesh(path("parts.msh"), mesh);
  EXPECT_THAT(describe(path("parts.msh")), HasSubstr("open: the mesh has 2 parts that share no node: 1 cell "
                                                     "from cell 1 on, 1 cell from cell 2 on"));
}

TEST_F(Describe, decks_with_materials_restraint_and_an_inverted_cell) {
  write_file(path("deck.inp"), R"(*NODE
1, 0., 0., 0.
2, 1., 0., 0.
3, 0., 1., 0.
4, 0., 0., -1.
*ELEMENT, TYPE=C3D4, ELSET=RIM
1, 1, 2, 3, 4
*MATERIAL, NAME=FIBRE
*ELASTIC, TYPE=ENGINEERING CONSTANTS
140., 9., 8., 0.3, 0.25, 0.4, 5., 4.,
3.
*DENSITY
1.6
*SOLID SECTION, ELSET=RIM, MATERIAL=FIBRE
*BOUNDARY
2, PINNED
1, 1, 2
)");
  EXPECT_THAT(describe(path("deck.inp")),
              AllOf(HasSubstr("scaled Jacobian: at least -1.41421 (cell 1)"),
                    HasSubstr("inverted: cell 1 is the first"),
                    HasSubstr("material of RIM: orthotropic, E = (140 9 8) Pa"),
                    HasSubstr("G_12 G_13 G_23 = (5 4 3) Pa"),
                    HasSubstr("restrained by the file: node set BOUNDARY\n"),
                    HasSubstr("restrained by the file: node set BOUNDARY_xy:xy")));
}

TEST_F(Describe, body_files) {
  write_modal(path("worm.h5"), sample_modal_body(), sample_modes());
  EXPECT_THAT(
      describe(path("worm.h5")),
      AllOf(HasSubstr("format: elastogear body, version 4"), HasSubstr("mass: 0.333333"),
            ContainsRegex("frequencies: 333.333, [0-9.]+, 9000 Hz"), HasSubstr("3 elastic coordinates"),
            HasSubstr("tooth_01_left"), HasSubstr("material of even: E = 1.1e+11 Pa"), HasSubstr("root: 2")));
}

TEST_F(Describe, recovery_of_stresses) {
  BodySource source = sample_source();
  const auto describe_with = [&](const model::StressRecovery& recovery) {
    source.recovery = recovery;
    BodyWriter(path("worm.h5"), source.mesh.n_nodes(), 0).finish(sample_full_body(), source);
    return describe(path("worm.h5"));
  };
  EXPECT_THAT(describe_with({}), HasSubstr("stress: 2 nodes, recovered by average\n"));
  EXPECT_THAT(describe_with({model::RecoveryMethod::surface, {0, 1, 4}}),
              HasSubstr("stress: 2 nodes, recovered by surface, forces may act on 3 nodes\n"));
}

TEST_F(Describe, checks_of_a_body) {
  BodySource source = sample_source();
  source.checks = {
      {"effective_mass", "kg", "of each mode", Eigen::MatrixXd::Constant(100, 3, 0.25)},
      {"static_completeness", "1", "shares", Eigen::MatrixXd::Constant(1, 1, 0.5), {"flank force"}}};
  BodyWriter(path("worm.h5"), source.mesh.n_nodes(), 0).finish(sample_full_body(), source);
  EXPECT_THAT(describe(path("worm.h5")),
              AllOf(HasSubstr("check effective_mass: of each mode\n  100 rows, 0.25 to 0.25 kg"),
                    HasSubstr("check static_completeness: shares\n  flank force: 0.5")));
}

TEST_F(Describe, result_files) {
  write_result(path("impact.h5"), sample_snapshots(5));
  EXPECT_THAT(describe(path("impact.h5")),
              AllOf(HasSubstr("times: 5 from 0 to 4e-06 s"), HasSubstr("wheel.h5, joint revolute, 5 elastic"),
                    HasSubstr("elastogear result, version 3"),
                    HasSubstr("touched at 4 surface nodes, largest contact force on one: "),
                    HasSubstr("most contacts: 3, largest penetration: 3e-06 m"), HasSubstr("peak force"),
                    HasSubstr("energy balance: at most 0.006 J off"), HasSubstr("-ts_dt 1e-6")));
}

TEST_F(Describe, stress_and_field_files) {
  write_stress(path("stress.h5"), sample_stress());
  EXPECT_THAT(
      describe(path("stress.h5")),
      AllOf(HasSubstr("worm/root: 2 nodes"), HasSubstr("peak von Mises: 1.23e+08 Pa at node 7, t = 2e-06 s"),
            HasSubstr("peak Rankine: 9.8e+07 Pa at node 4, t = 1e-06 s"),
            HasSubstr("estimated error of the reduction: none in the file"),
            HasSubstr("arrays:\n  /time: 3, s\n"), HasSubstr("  /worm/root/stress: 3 x 2 x 6, Pa\n")));
  const mesh::Mesh box = mesh::box_mesh({1, 1, 1});
  write_vtu(path("a.vtu"), box, {{"u <1> [m]", box.X}});
  EXPECT_THAT(
      describe(path("a.vtu")),
      AllOf(HasSubstr("VTK unstructured grid"), HasSubstr("points: 8, cells: 1\n"),
            HasSubstr("array of points: u <1> [m], components: 3\n"), Not(HasSubstr("connectivity"))));
}

TEST_F(Describe, collections_polygons_and_tables) {
  write_pvd(path("a.pvd"), {{0, "a_0.vtu", 0, "a"}, {1, "a_1.vtu", 0, "a"}, {0, "b_0.vtu", 1, "b"}});
  EXPECT_THAT(describe(path("a.pvd")),
              AllOf(HasSubstr("3 files: 2 times of a, b\n"), HasSubstr("  1 s: a_1.vtu\n")));
  write_polydata(path("a.vtp"), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {{"level", {3}}});
  EXPECT_THAT(describe(path("a.vtp")), AllOf(HasSubstr("points: 3, polygons: 1\n"),
                                             HasSubstr("array of cells: level, components: 1\n")));
  write_csv(path("a.csv"), {{"time", "s", Eigen::Vector2d(0, 1)}, {"force", "N", Eigen::Vector2d(2, 3)}});
  EXPECT_THAT(describe(path("a.csv")), HasSubstr("table, 2 rows\ncolumn: time [s]\ncolumn: force [N]\n"));
  write_file(path("b.vtu"), "nothing");
  EXPECT_THROW(describe(path("b.vtu")), Error);
}

TEST_F(Describe, estimated_errors_of_stresses) {
  StressFile history = sample_stress();
  history.sets[0].error = Eigen::MatrixXd::Constant(2, 3, 2e6);
  history.sets[0].error(0, 1) = 5e6;
  history.sets[0].peak_error = Eigen::Vector3d(1e6, 2e6, 1.23e6);
  write_stress(path("stress.h5"), history);
  EXPECT_THAT(describe(path("stress.h5")),
              HasSubstr("estimated error of the reduction: 1.23e+06 Pa of the peak (1 %), at most 5e+06 Pa"));
}

TEST_F(Describe, unknown_files_are_errors) {
  EXPECT_THROW(describe(path("none.h5")), Error);
  EXPECT_THROW(describe(folder.path.string()), Error);
  write_file(path("a.txt"), "text");
  EXPECT_THROW(describe(path("a.txt")), Error);
  H5Fclose(H5Fcreate(path("empty.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
  EXPECT_THROW(describe(path("empty.h5")), Error);
}

TEST_F(Describe, stress_files_round_trip_to_the_bit) {
  const StressFile a = sample_stress();
  write_stress(path("stress.h5"), a);
  const StressFile b = read_stress(path("stress.h5"));
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.provenance, b.provenance);
  ASSERT_EQ(b.sets.size(), 2u);
  const StressSet& root = b.sets[1];  // read in the order of names
  EXPECT_EQ(root.set, "root");
  EXPECT_EQ(root.node, a.sets[0].node);
  EXPECT_EQ(root.stress, a.sets[0].stress);
  EXPECT_EQ(root.von_mises, a.sets[0].von_mises);
  EXPECT_EQ(root.rankine, a.sets[0].rankine);
}

TEST_F(Describe, stress_files_refuse_shapes_that_disagree) {
  StressFile history = sample_stress();
  history.sets[0].rankine.resize(2, 2);
  EXPECT_THROW(write_stress(path("stress.h5"), history), Error);
  history = sample_stress();
  history.sets[0].body = "time";
  EXPECT_THROW(write_stress(path("stress.h5"), history), Error);
  EXPECT_EQ(folder.files(), 0);
}

}  // namespace
}  // namespace elastogear::describe_test
