// Worm and wheel together: placement, backlash, conjugacy.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "elastogear/gear/wheel.h"
#include "elastogear/gear/worm.h"

namespace elastogear::gear::pair_test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRoundoff = 1e-13;  // m
// The nodes nearest to a contact point miss it by up to half the spacing h = 0.5 mm: relative curvature 130/m
// (h/2)^2/2, with a factor of 2 for the spacing across.
constexpr double kMiss = 1e-5;  // m

Eigen::Vector3d turned(const Eigen::Vector3d& x, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * x[0] - s * x[1], s * x[0] + c * x[1], x[2]};
}
// Worm local (x, y, z) = world (Y, Z, X), worm axis through (0, a, 0).
Eigen::Vector3d world_of_worm(const Eigen::Vector3d& x, double a) { return {x[2], x[0] + a, x[1]}; }
Eigen::Vector3d worm_of_world(const Eigen::Vector3d& x, double a) { return {x[1] - a, x[2], x[0]}; }

// Smallest distance of worm flank nodes to the wheel's left and right flanks, m; negative: a node is in a
// tooth.
struct Gap {
  double left = 1, right = 1;
};

Gap gap(const mesh::Mesh& worm, const Design& d, double phi_1) {
  const Geometry g = derive(d);
  Gap gap;
  for (const mesh::Face& face : mesh::face_set(worm, "flanks"))
    for (int node : face) {
      const Eigen::Vector3d world = world_of_worm(turned(worm.X.col(node), phi_1), d.a);
      const Eigen::Vector3d x = turned(world, -phi_1 / g.ratio);
      const double r = x.head<2>().norm();
      if (r < g.wheel.r_form || r > g.wheel.r_a || std::abs(x[2]) > d.face_width / 2) continue;
      for (int tooth = 0; tooth < d.z2; ++tooth) {
        const double left = flank_distance(g.wheel, tooth, 1, x),
                     right = flank_distance(g.wheel, tooth, -1, x);
        (left > right ? gap.left : gap.right) =
            std::min(left > right ? gap.left : gap.right, std::max(left, right));
      }
    }
  return gap;
}

TEST(Pair, meshes_at_zero_angles_with_half_the_backlash_on_each_flank) {
  const Design d;
  const Gap g = gap(worm_mesh(d, worm_counts(Size::small)), d, 0);
  EXPECT_GT(g.left, d.j_n / 2 - kRoundoff);
  EXPECT_LT(g.left, d.j_n / 2 + kMiss);
  EXPECT_GT(g.right, d.j_n / 2 - kRoundoff);
  EXPECT_LT(g.right, d.j_n / 2 + kMiss);
}

TEST(Pair, keeps_its_gaps_when_turned_by_the_ratio) {
  const Design d;
  const mesh::Mesh worm = worm_mesh(d, worm_counts(Size::small));
  for (double phi_1 : {0.1, 0.9, 2.3, 4.0, -7.0}) {
    const Gap g = gap(worm, d, phi_1);
    EXPECT_GT(std::min(g.left, g.right), d.j_n / 2 - kRoundoff);
    EXPECT_LT(std::max(g.left, g.right), d.j_n / 2 + kMiss);
  }
}

// Along the straight path of contact through the pitch point both flanks' normals point along the path, so
// the distances to a worm and a wheel flank add up to the gap, whatever the angle; neighbouring flanks differ
// by p_bn.
TEST(Pair, is_conjugate_along_the_path_of_contact) {
  const Design d;
  const Geometry g = derive(d);
  for (int side : {-1, 1}) {  // of the worm; it meets the other side of the wheel's tooth
    const Eigen::Vector3d n(side * std::sin(g.worm.beta_b), std::sin(d.alpha_n),
                            side * std::sin(g.wheel.beta_b));
    EXPECT_NEAR(n.norm(), 1, kRoundoff);
    for (double t = -2e-3; t < 3e-3; t += 0.37e-3)
      for (double phi_1 : {0.0, 0.4, 5.0}) {
        const Eigen::Vector3d x = Eigen::Vector3d(0, g.wheel.r, 0) + t * n;
        const double d_1 = flank_distance(g.worm, 0, side, turned(worm_of_world(x, d.a), -phi_1));
        const double d_2 = flank_distance(g.wheel, 0, -side, turned(x, -phi_1 / g.ratio));
        EXPECT_NEAR(std::remainder(d_1 + d_2 - d.j_n / 2, g.p_bn), 0, kRoundoff);
      }
  }
}

TEST(Pair, fillets_keep_clear_of_the_mates_tips) {
  const Design d;
  const Geometry g = derive(d);
  const mesh::Mesh worm = worm_mesh(d, worm_counts(Size::small));
  for (double phi_1 : {0.0, 0.8, 1.6})
    for (int node : mesh::node_set(worm, "root")) {
      const Eigen::Vector3d world = world_of_worm(turned(worm.X.col(node), phi_1), d.a);
      const Eigen::Vector3d x = turned(world, -phi_1 / g.ratio);
      if (x.head<2>().norm() > g.wheel.r_a || std::abs(x[2]) > d.face_width / 2) continue;
      for (int tooth = 0; tooth < d.z2; ++tooth)
        EXPECT_GT(std::max(flank_distance(g.wheel, tooth, 1, x), flank_distance(g.wheel, tooth, -1, x)), 0);
    }
}

}  // namespace
}  // namespace elastogear::gear::pair_test
