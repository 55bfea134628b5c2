// The share of a force that is left over a free boundary of the master.
#include <gtest/gtest.h>

#include "elastogear/contact/face.h"

namespace elastogear::contact::end_share_test {
namespace {

constexpr double roundoff = 1e-11;

TEST(EndShare, falls_from_one_to_nothing_with_a_continuous_slope) {
  for (int sides : {3, 4}) {
    Face face;
    face.sides = sides;
    for (int side = 0; side < sides; ++side) {
      face.extension = {};
      face.extension[side] = 0.1;
      const Eigen::Vector2d at = on_side(sides, side, 0.3),
                            beyond = at + (at - on_side(sides, (side + 2) % sides, 0.5));
      const Eigen::Vector2d centre =
          0.5 * (extended_corner(face, side) + extended_corner(face, (side + 1) % sides));
      EXPECT_EQ(fade_factor(face, at[0], at[1]).f, 1);
      EXPECT_NEAR(fade_factor(face, centre[0], centre[1]).f, 0, roundoff);
      EXPECT_EQ(fade_factor(face, beyond[0], beyond[1]).f, 0);
      const Eigen::Vector2d half = 0.5 * (on_side(sides, side, 0.5) + centre);
      const FaceFunction fade = fade_factor(face, half[0], half[1]);
      EXPECT_NEAR(fade.f, 0.5, roundoff);
      for (const Eigen::Vector2d& p : {at, half, centre})
        for (int i : {0, 1}) {
          const double h = 1e-6;
          const Eigen::Vector2d e = h * Eigen::Vector2d::Unit(i), right = p + e, left = p - e;
          const double slope =
              (fade_factor(face, right[0], right[1]).f - fade_factor(face, left[0], left[1]).f) / (2 * h);
          EXPECT_NEAR(fade_factor(face, p[0], p[1]).f_a[i], slope, 1e-3);
        }
    }
  }
}

}  // namespace
}  // namespace elastogear::contact::end_share_test
