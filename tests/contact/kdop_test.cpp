#include <gtest/gtest.h>

#include "contact/search/realign.h"
#include "elastogear/base/error.h"
#include "surfaces.h"

namespace elastogear::contact::kdop_test {
namespace {

using test::Random;
constexpr int sizes[] = {6, 14, 18, 24, 26};
constexpr double roundoff = 1e-12;

Eigen::Matrix3Xd random_points(Random& random, int n, const Eigen::Vector3d& centre) {
  Eigen::Matrix3Xd points(3, n);
  for (auto p : points.colwise()) p = centre + random.vector(1);
  return points;
}

bool encloses(const Kdop& dop, const Eigen::Vector3d& x, double tolerance = 0) {
  const Directions& B = directions(dop.k);
  for (int i = 0; i < B.n; ++i)
    if (B[i].dot(x) < dop.lo[i] - tolerance || B[i].dot(x) > dop.hi[i] + tolerance) return false;
  return true;
}

TEST(Kdop, directions_are_pairwise_different_and_not_antiparallel) {
  for (int k : sizes) {
    const Directions& B = directions(k);
    EXPECT_EQ(B.n, k / 2);
    for (int i = 0; i < B.n; ++i)
      for (int j = 0; j < i; ++j) EXPECT_GT(B[i].cross(B[j]).norm(), 0.5) << k;
  }
}

TEST(Kdop, other_sizes_are_refused) { EXPECT_THROW(directions(8), Error); }

TEST(Kdop, of_points_holds_them_and_every_plane_touches_one) {
  Random random(1);
  for (int k : sizes) {
    const Eigen::Matrix3Xd points = random_points(random, 20, random.vector(3));
    const Kdop dop = tight_kdop(k, points);
    const Directions& B = directions(k);
    for (int i = 0; i < B.n; ++i) {
      EXPECT_NEAR(dop.lo[i], (B[i].transpose() * points).minCoeff(), roundoff);
      EXPECT_NEAR(dop.hi[i], (B[i].transpose() * points).maxCoeff(), roundoff);
    }
  }
}

TEST(Kdop, merged_is_the_kdop_of_all_points) {
  Random random(2);
  for (int k : sizes) {
    const Eigen::Matrix3Xd points = random_points(random, 20, random.vector(3));
    Kdop merged = empty_kdop(k);
    for (int i = 0; i < points.cols(); ++i) merge(merged, tight_kdop(k, points.col(i)));
    const Kdop dop = tight_kdop(k, points);
    EXPECT_EQ(merged.lo, dop.lo);
    EXPECT_EQ(merged.hi, dop.hi);
  }
}

TEST(Kdop, overlap_ends_where_one_direction_separates) {
  Eigen::Matrix3Xd corner(3, 4);  // tetrahedron under the plane x + y = 1, which only k >= 18 can see
  corner << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
  const Eigen::Vector3d beyond(0.6, 0.6, 0);
  for (int k : {18, 24, 26}) EXPECT_FALSE(overlap(tight_kdop(k, corner), tight_kdop(k, beyond))) << k;
  for (int k : sizes) {
    EXPECT_TRUE(overlap(tight_kdop(k, corner), tight_kdop(k, Eigen::Vector3d(1, 0, 0))))
        << "touching, k " << k;
    EXPECT_FALSE(overlap(tight_kdop(k, corner), tight_kdop(k, Eigen::Vector3d(1.1, 0, 0))));
  }
  EXPECT_TRUE(overlap(tight_kdop(6, corner), tight_kdop(6, beyond)));
}

TEST(Kdop, area_of_a_box_is_its_surface) {
  Eigen::Matrix3Xd points(3, 2);
  points << 0, 2, 0, 3, 0, 5;
  EXPECT_NEAR(area(tight_kdop(6, points)), 2 * (6 + 10 + 15), roundoff);
}

TEST(Polyhedron, has_its_corners_on_the_planes_and_satisfies_euler) {
  Random random(3);
  for (int k : sizes) {
    const Kdop dop = tight_kdop(k, random_points(random, 30, random.vector(2)));
    const Polyhedron p = polyhedron(dop);
    const Directions& B = directions(k);
    Kdop hull = empty_kdop(k);
    for (const auto& x : p.vertices) merge(hull, tight_kdop(k, x));
    for (int i = 0; i < B.n; ++i) {
      EXPECT_NEAR(hull.lo[i], dop.lo[i], roundoff);
      EXPECT_NEAR(hull.hi[i], dop.hi[i], roundoff);
    }
    int corners = 0;
    for (const auto& f : p.faces) corners += static_cast<int>(f.size());
    EXPECT_EQ(static_cast<int>(p.vertices.size()) - corners / 2 + static_cast<int>(p.faces.size()), 2);
  }
}

TEST(Polyhedron, of_a_flat_kdop_is_its_outline) {
  Eigen::Matrix3Xd square(3, 4);
  square << 0, 1, 1, 0, 0, 0, 1, 1, 0, 0, 0, 0;
  EXPECT_EQ(polyhedron(tight_kdop(26, square)).vertices.size(), 4u);
}

TEST(Realignment, encloses_the_moved_kdop) {
  Random random(4);
  for (int k : sizes)
    for (int trial = 0; trial < 20; ++trial) {
      const Kdop dop = tight_kdop(k, random_points(random, 4 + trial, random.vector(5)));
      const Eigen::Matrix3d R = test::rotation(random.vector(3));
      const Eigen::Vector3d r = random.vector(2);
      const Kdop moved = realigned(dop, realignment(k, R, r));
      for (const auto& x : polyhedron(dop).vertices) EXPECT_TRUE(encloses(moved, R * x + r, 1e-10)) << k;
    }
}

TEST(Realignment, encloses_moved_points_without_any_tolerance) {
  Random random(5);
  for (int k : sizes)
    for (int trial = 0; trial < 100; ++trial) {
      const Eigen::Matrix3Xd points = random_points(random, 4, random.vector(50));
      const Eigen::Matrix3d R = trial % 2 ? test::rotation(random.vector(3)) : Eigen::Matrix3d::Identity();
      const Kdop moved = realigned(tight_kdop(k, points), realignment(k, R, Eigen::Vector3d::Zero()));
      for (const auto& x : points.colwise()) EXPECT_TRUE(encloses(moved, R * x)) << k;
    }
}

TEST(Realignment, with_all_combinations_is_that_of_the_hull_points) {
  Random random(6);
  for (int k : sizes) {
    const Kdop dop = tight_kdop(k, random_points(random, 10, random.vector(1)));
    const Eigen::Matrix3d R = test::rotation(random.vector(3));
    const Kdop moved = realigned(dop, realignment(k, R, Eigen::Vector3d::Zero(), kAllCombinations));
    Kdop hull = empty_kdop(k);
    for (const auto& x : polyhedron(dop).vertices) merge(hull, tight_kdop(k, R * x));
    for (int i = 0; i < k / 2; ++i) {
      EXPECT_NEAR(moved.lo[i], hull.lo[i], roundoff);
      EXPECT_NEAR(moved.hi[i], hull.hi[i], roundoff);
    }
  }
}

TEST(Realignment, of_a_box_needs_one_combination) {
  Random random(7);
  const Kdop dop = tight_kdop(6, random_points(random, 5, random.vector(1)));
  const Eigen::Matrix3d R = test::rotation(random.vector(3));
  const Realignment one = realignment(6, R, Eigen::Vector3d::Zero(), 1);
  const Realignment all = realignment(6, R, Eigen::Vector3d::Zero(), kAllCombinations);
  EXPECT_EQ(realigned(dop, one).lo, realigned(dop, all).lo);
}

TEST(Realignment, by_few_combinations_is_hardly_larger_than_by_the_hull_points) {
  Random random(8);
  for (int k : {14, 18, 24, 26}) {
    double few_area = 0, hull_area = 0;
    for (int trial = 0; trial < 20; ++trial) {
      const Kdop dop = tight_kdop(k, random_points(random, 4, Eigen::Vector3d::Zero()));
      const Eigen::Matrix3d R = test::rotation(random.vector(3));
      few_area += area(realigned(dop, realignment(k, R, Eigen::Vector3d::Zero())));
      hull_area += area(realigned(dop, realignment(k, R, Eigen::Vector3d::Zero(), kAllCombinations)));
    }
    EXPECT_LT(few_area, 1.3 * hull_area) << k;
    RecordProperty("area_ratio_k" + std::to_string(k), std::to_string(few_area / hull_area));
  }
}

}  // namespace
}  // namespace elastogear::contact::kdop_test
