#include "elastogear/contact/initial_overlap.h"

#include <gtest/gtest.h>

#include "elastogear/base/error.h"
#include "surfaces.h"

namespace elastogear::contact::initial_overlap_test {
namespace {

using test::at;

TEST(InitialOverlap, of_separate_bodies_is_none) {
  const model::Surface ball = test::cube(8, test::onto_sphere);
  const InitialOverlap overlap = initial_overlap(ball, ball, {}, at(ball), at(ball, {2.01, 0, 0}));
  EXPECT_EQ(overlap.penetration, 0);
  EXPECT_FALSE(overlap.enclosed);
  EXPECT_NO_THROW(require_apart(overlap, "ball:ball"));
}

TEST(InitialOverlap, of_touching_bodies_is_reported_but_allowed) {
  const model::Surface ball = test::cube(8, test::onto_sphere);
  const InitialOverlap overlap = initial_overlap(ball, ball, {}, at(ball), at(ball, {1.99, 0, 0}));
  EXPECT_NEAR(overlap.penetration, 0.01, 1e-3);
  EXPECT_NO_THROW(require_apart(overlap, "ball:ball"));
}

TEST(InitialOverlap, of_bodies_deep_inside_each_other_is_refused) {
  const model::Surface ball = test::cube(8, test::onto_sphere);
  for (double distance : {1.8, 1.0, 0.3})
    EXPECT_THROW(
        require_apart(initial_overlap(ball, ball, {}, at(ball), at(ball, {distance, 0.1, 0})), "ball:ball"),
        Error);
}

TEST(InitialOverlap, of_a_body_wholly_inside_another_is_refused) {
  const model::Surface outer =
      test::cube(8, [](const Eigen::Vector3d& x) { return Eigen::Vector3d(10 * x); });
  const model::Surface inner = test::cube(3, test::onto_sphere);
  const InitialOverlap overlap = initial_overlap(outer, inner, {}, at(outer), at(inner));
  EXPECT_TRUE(overlap.enclosed);
  EXPECT_EQ(overlap.slave_side, 1);
  EXPECT_THROW(require_apart(overlap, "outer:inner"), Error);
}

TEST(InitialOverlap, of_open_flanks_that_cross_is_refused) {
  const model::Surface flank = test::plane(8, 8), other = test::flipped(flank);
  EXPECT_THROW(
      require_apart(initial_overlap(flank, other, {}, at(flank), at(other, {0.1, 0, 0.1}, {0, 0.5, 0})),
                    "a:b"),
      Error);
  EXPECT_NO_THROW(
      require_apart(initial_overlap(flank, other, {}, at(flank), at(other, {0, 0, 0.01})), "a:b"));
}

// The upper nodes of a sheet in front of a plate face as the plate's front does, and oppose its back alone.
TEST(InitialOverlap, of_a_node_in_front_of_its_nearest_face_is_none) {
  const auto flat = [](double length, double height) {
    return [=](const Eigen::Vector3d& x) {
      return Eigen::Vector3d(length * x[0], length * x[1], height * x[2]);
    };
  };
  const model::Surface plate = test::cube(4, flat(1, 0.1)), sheet = test::cube(4, flat(0.5, 0.002));
  TrueSurface thicker;
  thicker.deviation = Eigen::VectorXd::Constant(plate.X.cols(), 0.02);
  const InitialOverlap overlap =
      initial_overlap(plate, sheet, {}, at(plate), at(sheet, {0, 0, 0.107}), {&thicker, nullptr});
  EXPECT_NEAR(overlap.penetration, 0.015, 1e-9);
}

TEST(InitialOverlap, counts_what_stands_out_of_the_facets) {
  const model::Surface flank = test::plane(8, 8), other = test::flipped(flank);
  const SurfaceState below = at(flank), above = at(other, {0, 0, 0.01});
  EXPECT_EQ(initial_overlap(flank, other, {}, below, above).penetration, 0);
  TrueSurface thicker;
  thicker.deviation = Eigen::VectorXd::Constant(flank.X.cols(), 0.05);
  const InitialOverlap overlap = initial_overlap(flank, other, {}, below, above, {&thicker, nullptr});
  EXPECT_NEAR(overlap.penetration, 0.04, 1e-12);
}

}  // namespace
}  // namespace elastogear::contact::initial_overlap_test
