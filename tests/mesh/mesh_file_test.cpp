#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../fem/other_cells.h"
#include "box_mesh.h"
#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "elastogear/mesh/file.h"
#include "mesh/inp/lines/inp.h"
#include "mesh/msh/msh.h"

namespace elastogear::mesh_file_test {
using namespace mesh;

namespace {

std::string message(const std::string& path) {
  try {
    read_mesh(path);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

struct MeshFile : testing::TestWithParam<const char*> {
  Folder folder{"mesh_file"};
  Mesh mesh = box_mesh_with_sets({3, 2, 2});
  std::string path = folder / (std::string(GetParam()) == "inp" ? "box.inp" : "box.msh");

  void write(const Mesh& m) const {
    if (std::string(GetParam()) == "inp") return write_inp(path, m);
    write_msh(path, m, std::string(GetParam()) == "ascii" ? Encoding::ascii : Encoding::binary);
  }
};

TEST_P(MeshFile, gives_the_same_mesh_back_to_the_bit) {
  write(mesh);
  ReadReport report;
  EXPECT_TRUE(equal(read_mesh(path, 1, &report), mesh));
  EXPECT_TRUE(report.ignored.empty());
  EXPECT_EQ(folder.files(), 1);
}

TEST_P(MeshFile, gives_cells_of_every_type_back) {
  const Mesh brick = test::brick({2, 2, 2}, {1, 1, 1});
  std::vector<Mesh> meshes = {test::mixed(brick, 2),
                              test::second_order(test::hexahedra_and_wedges(brick, 2))};
  for (CellType type : test::all_cell_types()) meshes.push_back(test::cells_of(type, brick));
  for (Mesh& m : meshes) {
    m.cell_sets["first"] = {0};
    write(m);
    EXPECT_TRUE(equal(read_mesh(path), m)) << name(m.cells.type[0]);
  }
}

TEST_P(MeshFile, converts_the_unit_of_length) {
  write(mesh);
  EXPECT_EQ(read_mesh(path, 0.25).X, 0.25 * mesh.X);
  EXPECT_THROW(read_mesh(path, 0), Error);
  EXPECT_THROW(read_mesh(path, NAN), Error);
}

TEST_P(MeshFile, is_an_error_when_truncated_anywhere_before_the_end) {
  mesh = box_mesh_with_sets({1, 1, 1});
  write(mesh);
  const std::string content = read_file(path);
  for (std::size_t n = 0; n < content.size(); ++n) {
    write_file(path, content.substr(0, n));
    if (n + 1 < content.size()) {
      EXPECT_THROW(read_mesh(path), Error) << "cut at byte " << n;
    } else {  // only the last line end is missing
      const std::string text = message(path);
      EXPECT_TRUE(text == "no error" || text.find("truncated") != std::string::npos) << text;
    }
  }
}

TEST_P(MeshFile, with_a_damaged_byte_is_an_error_or_another_mesh) {
  mesh = box_mesh_with_sets({1, 1, 1});
  write(mesh);
  const std::string content = read_file(path);
  const std::string bytes = {'\0', '-', '9', '\xff', '\n'};
  for (std::size_t n = 0; n < content.size(); ++n) {
    std::string damaged = content;
    damaged[n] = bytes[n % bytes.size()];
    write_file(path, damaged);
    try {
      read_mesh(path);
    } catch (const Error&) {
    }
  }
}

TEST_P(MeshFile, of_an_invalid_mesh_is_not_written) {
  write(mesh);
  const std::string before = read_file(path);
  Mesh broken = mesh;
  broken.X(1, 4) = NAN;
  EXPECT_THROW(write(broken), Error);
  broken = mesh;
  broken.node_sets["seat"].push_back(mesh.n_nodes());
  EXPECT_THROW(write(broken), Error);
  broken = mesh;
  broken.face_sets["two"].push_back({0, 1, 2, 3});
  EXPECT_THROW(write(broken), Error);
  broken = mesh;
  broken.cell_sets["a \"name\""] = {0};
  EXPECT_THROW(write(broken), Error);
  EXPECT_EQ(read_file(path), before);
  EXPECT_EQ(folder.files(), 1);
}

INSTANTIATE_TEST_SUITE_P(Formats, MeshFile, testing::Values("ascii", "binary", "inp"),
                         [](const auto& info) { return std::string(info.param); });

TEST(MeshFiles, have_names_that_body_files_can_hold) {
  Folder folder{"mesh_names"};
  for (const char* card : {"*ELSET, ELSET=A/B\n1\n", "*NSET, NSET=A/B\n1\n", "*SURFACE, NAME=A/B\n1, S1\n"}) {
    const std::string path = folder / "named.inp";
    write_file(
        path,
        std::string("*NODE\n1\n2, 1\n3, 0, 1\n4, 0, 0, 1\n*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n") + card);
    EXPECT_THAT(message(path), testing::HasSubstr("a set has the name 'A/B'")) << card;
  }
}

TEST(MeshFiles, name_what_is_wrong_with_the_path) {
  const Folder folder("mesh_path");
  EXPECT_THAT(message(folder / "none.msh"), testing::HasSubstr("none.msh"));
  EXPECT_THAT(message(folder / "none.inp"), testing::HasSubstr("none.inp"));
  EXPECT_THAT(message(folder / "a.stl"), testing::HasSubstr("unknown mesh format '.stl'"));
  EXPECT_THAT(message(folder / "a.stl"), testing::Not(testing::HasSubstr("gmsh")));
  EXPECT_THROW(write_mesh(folder / "a.stl", box_mesh({1, 1, 1})), Error);
}

TEST(MeshFiles, of_nastran_are_refused_with_the_command_that_converts_them) {
  EXPECT_THAT(message("gears/deck.BDF"),
              testing::AllOf(testing::HasSubstr("unknown mesh format '.bdf'"),
                             testing::HasSubstr("without materials, restraints and local coordinate systems"),
                             testing::EndsWith("\"gmsh gears/deck.BDF -save -o gears/deck.inp\"")));
  EXPECT_THAT(message("deck.nas"), testing::EndsWith("\"gmsh deck.nas -save -o deck.inp\""));
  EXPECT_THAT(message("deck.dat"),
              testing::EndsWith("\"cp deck.dat deck.bdf && gmsh deck.bdf -save -o deck.inp\""));
}

}  // namespace
}  // namespace elastogear::mesh_file_test
