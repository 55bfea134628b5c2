// Nodes at open sides and on sharp convex edges, and that they keep a master from entering between the nodes
// of a slave.
#include "contact/projection/edges.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "elastogear/contact/pair.h"
#include "surfaces.h"

namespace elastogear::contact::edges_test {
namespace {

using Eigen::Vector3d;

constexpr double kFeatureAngle = 0.5;  // rad

std::vector<bool> edges_of(const model::Surface& s, double feature_angle = kFeatureAngle) {
  const Topology t = topology(s.face, static_cast<int>(s.X.cols()));
  return edge_nodes({s.face, t, s.X, 0}, feature_angle);
}

model::Surface cube(double half) {
  return test::cube(4, [=](const Vector3d& x) { return Vector3d(half * x); });
}

// Is the place on at least two sides of the cube?
bool is_on_edge(const Vector3d& x, double half) { return (x.array().abs() > half - 1e-9).count() >= 2; }

TEST(Edges, are_marked_where_they_are_convex_and_sharp) {
  const model::Surface s = cube(1);
  const std::vector<bool> marked = edges_of(s), of_hole = edges_of(test::flipped(s)),
                          of_ball = edges_of(s, test::pi);
  for (int node = 0; node < s.X.cols(); ++node) {
    EXPECT_EQ(marked[node], is_on_edge(s.X.col(node), 1)) << s.X.col(node).transpose();
    EXPECT_FALSE(of_hole[node]);
    EXPECT_FALSE(of_ball[node]);
  }
}

TEST(Edges, are_marked_at_open_sides) {
  for (const model::Surface& s : {test::plane(3, 2), test::triangulated(test::plane(3, 2))}) {
    const std::vector<bool> marked = edges_of(s);
    EXPECT_EQ(std::count(marked.begin(), marked.end(), true), 10);
  }
}

// A cube of 0.2 m under the middle of one face of 1 m, which no node of that face is near to.
TEST(Edges, of_the_master_meet_faces_of_the_slave_without_a_penalty) {
  const model::Surface slave = test::flipped(test::plane(3, 3, 3, 3)), master = cube(0.1);
  const SurfaceState a{slave.X, Vector3d(-1.5, -1.5, 0.1 - 1e-4), Eigen::Matrix3d::Identity()},
      b{master.X, Vector3d::Zero(), Eigen::Matrix3d::Identity()};
  Settings s;
  s.surface = ContactSurface::facets;
  s.depth = 0.05;
  s.law = ContactLaw::penalty;
  EXPECT_TRUE(Pair(slave, master, s).detect(a, b).empty());
  for (ContactLaw law : {ContactLaw::unilateral, ContactLaw::augmented}) {
    s.law = law;
    const std::vector<ContactPoint> found = Pair(slave, master, s).detect(a, b);
    EXPECT_EQ(found.size(), 16u);  // of the square's 25 nodes those on its edges
    for (const ContactPoint& point : found) {
      EXPECT_EQ(point.slave_side, 1);
      EXPECT_TRUE(is_on_edge(master.X.col(point.slave_node), 0.1));
      EXPECT_NEAR(point.g_n, -1e-4, 1e-12);
    }
  }
}

}  // namespace
}  // namespace elastogear::contact::edges_test
