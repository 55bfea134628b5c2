#include <gtest/gtest.h>

#include <algorithm>

#include "box_mesh.h"
#include "elastogear/base/error.h"
#include "elastogear/mesh/partition.h"

namespace elastogear::partition_test {
using namespace mesh;

namespace {

TEST(Partition, is_balanced) {
  const Mesh mesh = box_mesh({12, 10, 9});
  for (const int n : {2, 3, 4, 7}) {
    const Partition partition = partition_cells(mesh, n);
    std::vector<int> count(n);
    for (int part : partition.part) ++count.at(part);
    const double mean = static_cast<double>(mesh.cells.size()) / n;
    EXPECT_LE(*std::max_element(count.begin(), count.end()), 1.05 * mean) << n << " parts";
    EXPECT_GT(*std::min_element(count.begin(), count.end()), 0);
  }
}

TEST(Partition, is_the_same_every_time) {
  const Mesh mesh = box_mesh({6, 6, 6});
  EXPECT_EQ(partition_cells(mesh, 5).part, partition_cells(mesh, 5).part);
}

TEST(Partition, cuts_a_long_bar_across) {
  const Partition partition = partition_cells(box_mesh({40, 2, 2}), 2);
  EXPECT_EQ(partition.edge_cut, 4);
}

TEST(Partition, counts_the_faces_between_parts) {
  const Mesh mesh = box_mesh({5, 4, 3});
  const Partition partition = partition_cells(mesh, 3);
  std::map<Face, std::vector<int>> parts;
  for (int i = 0; i < mesh.cells.size(); ++i)
    for (Face face : cell_faces(mesh.cells.type[i], mesh.cells[i])) {
      std::sort(face.begin(), face.end());
      parts[face].push_back(partition.part[i]);
    }
  const auto cut = std::count_if(parts.begin(), parts.end(), [](const auto& p) {
    return p.second.size() == 2 && p.second[0] != p.second[1];
  });
  EXPECT_EQ(partition.edge_cut, cut);
}

TEST(Partition, into_one_part_needs_no_cut) {
  const Partition partition = partition_cells(box_mesh({2, 1, 1}), 1);
  EXPECT_EQ(partition.part, (std::vector{0, 0}));
  EXPECT_EQ(partition.edge_cut, 0);
}

TEST(Partition, refuses_more_parts_than_cells) {
  EXPECT_THROW(partition_cells(box_mesh({2, 1, 1}), 3), Error);
  EXPECT_THROW(partition_cells(box_mesh({2, 1, 1}), 0), Error);
}

}  // namespace
}  // namespace elastogear::partition_test
