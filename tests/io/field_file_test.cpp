#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "../fem/other_cells.h"
#include "../mesh/box_mesh.h"
#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "elastogear/io/csv.h"
#include "elastogear/io/field_file.h"

namespace elastogear::field_file_test {
using namespace io;
using testing::HasSubstr;

namespace {

struct FieldFile : testing::Test {
  mesh::Folder folder{"field"};
  mesh::Mesh mesh = mesh::box_mesh({2, 1, 1});
};

// The appended array that the attribute offset of `name` points to.
template <class T>
std::vector<T> appended(const std::string& file, const std::string& name) {
  const std::size_t entry = file.find(name), start = file.find("offset=\"", entry) + 8;
  const char* data =
      file.data() + file.find('_', file.find("encoding=\"raw\"")) + 1 + std::stoul(file.substr(start));
  std::uint64_t size = 0;
  std::memcpy(&size, data, sizeof size);
  std::vector<T> values(size / sizeof(T));
  std::memcpy(values.data(), data + sizeof size, size);
  return values;
}

TEST_F(FieldFile, holds_mesh_and_fields_as_bytes) {
  const Eigen::MatrixXd stress = Eigen::MatrixXd::Random(6, mesh.n_nodes());
  write_vtu(folder / "a.vtu", mesh, {{"u [m]", mesh.X}, {"stress [Pa]", stress}});
  const std::string file = read_file(folder / "a.vtu");
  EXPECT_THAT(file, HasSubstr("NumberOfPoints=\"12\" NumberOfCells=\"2\""));
  EXPECT_THAT(file, HasSubstr("ComponentName4=\"YZ\""));
  const auto values = appended<double>(file, "stress [Pa]");
  EXPECT_EQ(Eigen::Map<const Eigen::VectorXd>(values.data(), values.size()), stress.reshaped());
  EXPECT_EQ(appended<int>(file, "connectivity"), mesh.cells.nodes);
  EXPECT_THAT(appended<int>(file, "offsets"), testing::ElementsAre(8, 16));
  EXPECT_THAT(appended<std::uint8_t>(file, "types"), testing::ElementsAre(12, 12));
}

TEST_F(FieldFile, turns_the_first_triangle_of_a_wedge_outward_as_vtk_does) {
  using mesh::CellType;
  const mesh::Mesh wedges = test::cells_of(CellType::wedge15, test::brick({1, 1, 1}, {1, 1, 1}));
  write_vtu(folder / "a.vtu", wedges, {});
  const std::string file = read_file(folder / "a.vtu");
  EXPECT_THAT(appended<std::uint8_t>(file, "types"), testing::ElementsAre(26, 26));
  const auto nodes = appended<int>(file, "connectivity");
  const auto side = [&](int a, int b) { return (wedges.X.col(nodes[b]) - wedges.X.col(nodes[a])).eval(); };
  EXPECT_LT(side(0, 1).cross(side(0, 2)).dot(side(0, 3)), 0);
  // VTK's edges of the wedge: round the first triangle, round the second, then along.
  const int ends[][2] = {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}};
  for (int e = 0; e < 9; ++e)
    EXPECT_EQ(wedges.X.col(nodes[6 + e]),
              (wedges.X.col(nodes[ends[e][0]]) + wedges.X.col(nodes[ends[e][1]])) / 2);
}

TEST_F(FieldFile, refuses_fields_that_do_not_fit_or_are_not_finite) {
  EXPECT_THROW(write_vtu(folder / "a.vtu", mesh, {{"u", Eigen::MatrixXd::Zero(3, 2)}}), Error);
  EXPECT_THROW(write_vtu(folder / "a.vtu", mesh, {{"u", Eigen::MatrixXd::Constant(1, 12, NAN)}}), Error);
  EXPECT_EQ(folder.files(), 0);
}

TEST_F(FieldFile, series_lists_times_parts_and_files) {
  write_pvd(folder / "a.pvd", {{0.1, "a_0.vtu", 0, ""}, {1.0 / 3, "a&b.vtu", 1, "<b>"}});
  EXPECT_THAT(read_file(folder / "a.pvd"),
              HasSubstr("timestep=\"0.10000000000000001\" part=\"0\" file=\"a_0.vtu\""));
  EXPECT_THAT(read_file(folder / "a.pvd"), HasSubstr("part=\"1\" name=\"&lt;b>\" file=\"a&amp;b.vtu\""));
}

TEST_F(FieldFile, table_has_units_in_its_header_and_exact_numbers) {
  write_csv(folder / "a.csv",
            {{"time", "s", Eigen::Vector2d(0, 0.1)}, {"force", "N", Eigen::Vector2d(-1e10, 1.0 / 3)}});
  EXPECT_EQ(read_file(folder / "a.csv"), "time [s],force [N]\n0,-1e+10\n0.1,0.3333333333333333\n");
}

TEST_F(FieldFile, table_refuses_ragged_columns_and_names_with_commas) {
  EXPECT_THROW(
      write_csv(folder / "a.csv", {{"a", "1", Eigen::Vector2d(0, 1)}, {"b", "1", Eigen::Vector3d(0, 1, 2)}}),
      Error);
  EXPECT_THROW(write_csv(folder / "a.csv", {{"a,b", "1", Eigen::Vector2d(0, 1)}}), Error);
}

}  // namespace
}  // namespace elastogear::field_file_test
