#include "elastogear/mesh/named_nodes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../fem/brick.h"
#include "../message_of.h"

namespace elastogear::named_nodes_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(NamedNodes, are_those_of_a_node_set_or_of_the_faces_of_a_face_set) {
  auto mesh = test::brick({2, 1, 1}, {1, 1, 1});
  const std::vector<int> xmin = mesh.node_sets.at("xmin");
  mesh.node_sets.erase("xmin");
  EXPECT_EQ(mesh::named_nodes(mesh, "xmin").node, xmin);
  EXPECT_TRUE(mesh::named_nodes(mesh, "xmin").of_faces);
  EXPECT_FALSE(mesh::named_nodes(mesh, "xmax").of_faces);
  EXPECT_EQ(mesh::named_nodes(mesh, "xmax").other_of_faces, 0) << "both sets have the same nodes";
}

TEST(NamedNodes, of_two_different_sets_are_those_of_the_node_set) {
  auto mesh = test::brick({2, 1, 1}, {1, 1, 1});
  mesh.node_sets["xmin"] = {5};
  const mesh::NamedNodes nodes = mesh::named_nodes(mesh, "xmin");
  EXPECT_EQ(nodes.node, std::vector<int>{5});
  EXPECT_FALSE(nodes.of_faces);
  EXPECT_EQ(nodes.other_of_faces, 4);
}

TEST(NamedNodes, of_an_unknown_name_are_an_error_that_lists_the_sets) {
  auto mesh = test::brick({1, 1, 1}, {1, 1, 1});
  mesh.node_sets = {{"a", {0}}, {"b", {1}}};
  mesh.face_sets = {};
  EXPECT_THAT(test::message_of([&] { mesh::named_nodes(mesh, "bore"); }),
              AllOf(HasSubstr("'bore'"), HasSubstr("node sets: a, b"), HasSubstr("face sets: none")));
}

}  // namespace
}  // namespace elastogear::named_nodes_test
