#include "elastogear/io/matrix_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "elastogear/base/error.h"

namespace elastogear::matrix_text_test {
namespace {

using namespace io;
using testing::HasSubstr;

std::vector<MatrixEntry> read(const std::string& text, MatrixFormat format = MatrixFormat::automatic,
                              std::size_t piece = 2) {
  std::istringstream in(text);
  MatrixReader reader(in, "k.mtx", format);
  std::vector<MatrixEntry> all;
  for (auto some = reader.read(piece); !some.empty(); some = reader.read(piece))
    all.insert(all.end(), some.begin(), some.end());
  return all;
}

std::string error_of(const std::function<void()>& f) {
  try {
    f();
  } catch (const elastogear::Error& error) {
    return error.what();
  }
  return "";
}

void expect(const MatrixEntry& e, const MatrixLabel& row, const MatrixLabel& column, double value) {
  EXPECT_EQ(e.row, row);
  EXPECT_EQ(e.column, column);
  EXPECT_EQ(e.value, value);
}

TEST(MatrixReader, reads_node_direction_pairs_of_abaqus) {
  const auto entries = read("** stiffness\n1,1, 1,1, 1.000000000000000e+36\n12,3, 7,2, -2.5e+05\n");
  ASSERT_EQ(entries.size(), 2u);
  expect(entries[0], {1, 1}, {1, 1}, 1e36);
  expect(entries[1], {12, 3}, {7, 2}, -2.5e5);
}

TEST(MatrixReader, reads_rows_and_columns_of_calculix_and_fortran) {
  const auto entries =
      read("1 1  4.9358974358974e+04\n\n# comment\n1 2 -1.5D+02\n3,3,+7", MatrixFormat::calculix);
  ASSERT_EQ(entries.size(), 3u);
  expect(entries[0], {1, 0}, {1, 0}, 4.9358974358974e4);
  expect(entries[1], {1, 0}, {2, 0}, -150);
  expect(entries[2], {3, 0}, {3, 0}, 7);
}

TEST(MatrixReader, reads_matrix_market_and_counts_its_entries) {
  const std::string banner = "%%MatrixMarket matrix coordinate real symmetric\n% comment\n2 2 3\n";
  EXPECT_EQ(read(banner + "1 1 1\n2 1 2\n2 2 3\n").size(), 3u);
  EXPECT_THAT(error_of([&] { read(banner + "1 1 1\n2 1 2\n"); }), HasSubstr("after 2 of 3"));
  EXPECT_THAT(error_of([&] { read(banner + "1 1 1\n3 1 2\n"); }), HasSubstr("line 5: row or column 3"));
  EXPECT_THAT(error_of([] { read("%%MatrixMarket matrix array real general\n1 1\n1\n"); }),
              HasSubstr("coordinate"));
  EXPECT_THAT(error_of([] { read("%%MatrixMarket matrix coordinate real general\n2 3 1\n1 1 1\n"); }),
              HasSubstr("3 columns"));
}

TEST(MatrixReader, names_file_and_line_of_what_is_no_matrix) {
  const auto message = [](const std::string& text) { return error_of([&] { read(text); }); };
  EXPECT_THAT(message("1 1 1\n1 2 nan\n"), HasSubstr("k.mtx, line 2: 'nan'"));
  EXPECT_THAT(message("1 1 inf\n"), HasSubstr("finite"));
  EXPECT_THAT(message("1 1 1e999\n"), HasSubstr("finite"));
  EXPECT_THAT(message("1 1 1\n1 2\n"), HasSubstr("line 2: has 2 fields"));
  EXPECT_THAT(message("0 1 1\n"), HasSubstr("at least 1"));
  EXPECT_THAT(message("1 99999999999999999999 1\n"), HasSubstr("whole number"));
  EXPECT_THAT(message("1,4, 1,4, 1\n"), HasSubstr("direction 4"));
  EXPECT_THAT(message("*MATRIX,TYPE=STIFFNESS\n1,2,3\n"), HasSubstr("keyword *MATRIX"));
  EXPECT_THAT(message(""), HasSubstr("no entries"));
  EXPECT_THAT(message("1 1 " + std::string(2000, '1')), HasSubstr("longer than 1023"));
  EXPECT_THAT(error_of([] { read("1 1 1\n", MatrixFormat::abaqus); }), HasSubstr("must have 5"));
}

TEST(NodeTable, is_sorted_by_number) {
  std::istringstream in("# number x y z\n7, 1.5, 2, 3\n2 4 5 6\n");
  const NodeTable table = read_node_table(in, "nodes.txt");
  EXPECT_EQ(table.number, (std::vector<std::int64_t>{2, 7}));
  EXPECT_EQ(table.X.col(0), Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(table.X.col(1), Eigen::Vector3d(1.5, 2, 3));
}

TEST(NodeTable, refuses_repeated_and_incomplete_nodes) {
  const auto message = [](const std::string& text) {
    std::istringstream in(text);
    return error_of([&] { read_node_table(in, "nodes.txt"); });
  };
  EXPECT_THAT(message("1 0 0 0\n1 1 0 0\n"), HasSubstr("node 1 is given twice"));
  EXPECT_THAT(message("1 0 0\n"), HasSubstr("line 1"));
  EXPECT_THAT(message("1 0 0 nan\n"), HasSubstr("'nan'"));
  EXPECT_THAT(message("\n"), HasSubstr("no nodes"));
}

TEST(DofTable, reads_calculix_and_pairs) {
  std::istringstream dots("2.2\n10.3\n"), pairs("2 2\n10, 3\n");
  const std::vector<MatrixLabel> expected{{2, 2}, {10, 3}};
  EXPECT_EQ(read_dof_table(dots, "a.dof"), expected);
  EXPECT_EQ(read_dof_table(pairs, "a.dof"), expected);
}

TEST(DofTable, refuses_what_is_no_displacement) {
  const auto message = [](const std::string& text) {
    std::istringstream in(text);
    return error_of([&] { read_dof_table(in, "a.dof"); });
  };
  EXPECT_THAT(message("1.1\n2.5\n"), HasSubstr("a.dof, line 2: direction 5"));
  EXPECT_THAT(message("1.1\n1.1\n"), HasSubstr("node 1, direction 1 is given twice"));
  EXPECT_THAT(message("1.0\n"), HasSubstr("node.direction"));
  EXPECT_THAT(message("x\n"), HasSubstr("'x'"));
  EXPECT_THAT(message(""), HasSubstr("no displacements"));
}

}  // namespace
}  // namespace elastogear::matrix_text_test
