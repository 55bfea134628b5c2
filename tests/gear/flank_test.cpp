// The exact flanks behind the faces of a mesh.
#include "elastogear/gear/flank.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

namespace elastogear::gear::flank_test {
namespace {

using Eigen::Vector3d;

Vector3d point(const Toothing& t, const Flank& flank, double r, double z) {
  const double theta = tooth_angle(t, flank.tooth) + z / t.p + flank.side * psi(t, r);
  return {r * std::cos(theta), r * std::sin(theta), z};
}

TEST(Flank, is_read_from_the_names_of_the_meshers_face_sets) {
  const auto is = [](const char* name, int tooth, int side) {
    const auto flank = flank_of(name);
    return flank && flank->tooth == tooth && flank->side == side;
  };
  EXPECT_TRUE(is("tooth_07_left", 6, 1));
  EXPECT_TRUE(is("tooth_41_right", 40, -1));
  EXPECT_TRUE(is("thread_2_right", 1, -1));
  for (const char* other : {"left", "flanks", "tooth_left", "tooth_0_left", "tooth_x_left", "tooth_1x_left",
                            "tooth_1_middle", "root_1_left", "tooth__left", ""})
    EXPECT_FALSE(flank_of(other)) << other;
}

TEST(Flank, normal_is_the_gradient_of_the_distance) {
  const Geometry g = derive(Design{});
  const double h = 1e-7;
  for (const Toothing& t : {g.worm, g.wheel})
    for (int side : {-1, 1}) {
      const Flank flank{1, side};
      const Vector3d x = point(t, flank, t.r, 1e-3) + Vector3d(1e-5, 2e-5, -1e-5);
      const auto distance = [&](const Vector3d& y) { return flank_distance(t, flank.tooth, flank.side, y); };
      for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(flank_normal(t, flank, x)[i],
                    (distance(x + h * Vector3d::Unit(i)) - distance(x - h * Vector3d::Unit(i))) / (2 * h),
                    1e-6);
    }
}

// Involute helicoids are developable: no curvature along their generators, cos(beta_b) / sqrt(r^2 - r_b^2)
// across.
TEST(Flank, curvature_of_involute_helicoids_is_that_of_developable_surfaces) {
  const Geometry g = derive(Design{});
  for (const Toothing& t : {g.worm, g.wheel})
    for (int side : {-1, 1}) {
      const Flank flank{1, side};
      const Vector3d x = point(t, flank, t.r, 1e-3), n = flank_normal(t, flank, x);
      const Eigen::Matrix3d S = flank_curvature(t, flank, x);
      const Vector3d across = n.cross(Vector3d::UnitZ() - n[2] * n).normalized();
      const double kappa = std::cos(t.beta_b) / std::sqrt(t.r * t.r - t.r_b * t.r_b);
      EXPECT_LT((S - kappa * across * across.transpose()).norm(), 1e-5 * kappa);
    }
}

TEST(Flank, is_met_along_any_line_that_leaves_it_steeply) {
  const Geometry g = derive(Design{});
  for (const Toothing& t : {g.worm, g.wheel})
    for (int side : {-1, 1})
      for (double r : {t.r_form, t.r, t.r_a}) {
        const Flank flank{0, side};
        const Vector3d on = point(t, flank, r, -2e-3);
        const Vector3d n = (flank_normal(t, flank, on) + Vector3d(0.1, -0.2, 0.1)).normalized();
        for (double s : {-1e-4, 0.0, 3e-5})
          EXPECT_NEAR(flank_distance_along(t, flank, on - s * n, n), s, 1e-15);
        EXPECT_TRUE(std::isnan(flank_distance_along(t, flank, on + 1e-5 * n, -n))) << "from behind";
      }
}

}  // namespace
}  // namespace elastogear::gear::flank_test
