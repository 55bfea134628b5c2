// What a sticking node remembers, from step to step.
#include <gtest/gtest.h>

#include "surfaces.h"

namespace elastogear::contact::stick_test {
namespace {

using Eigen::Vector3d;

constexpr double kStiffness = 1e3, kDepth = 0.01;  // N/m, m

Settings sticking(double mu) {
  Settings s;
  s.surface = ContactSurface::facets;
  s.stiffness = kStiffness;
  s.penalty = Penalty::per_node;
  s.depth = 0.1;
  s.friction = {.mu = mu, .law = FrictionLaw::stick};
  return s;
}

// Force on a small punch in each step of its way over a plane of n x n faces, which turns with it.
std::vector<Vector3d> forces_on_the_way(int n, double mu, const Vector3d& turn) {
  const model::Surface plane = test::plane(n, n), punch = test::flipped(test::plane(1, 1, 1e-3, 1e-3));
  Pair pair(punch, plane, sticking(mu));
  std::vector<Vector3d> forces;
  for (int step = 0; step <= 20; ++step) {
    const Eigen::Matrix3d R = test::rotation(step * turn);
    const Vector3d way(0.1 + 0.03 * step, 0.2 + 0.02 * step, -kDepth);
    const auto contacts =
        pair.detect(SurfaceState{punch.X, R * way, R}, SurfaceState{plane.X, Vector3d::Zero(), R});
    EXPECT_EQ(contacts.size(), 4u);
    forces.push_back(R.transpose() * test::total_force(contacts));
    pair.accept(contacts);
  }
  return forces;
}

// Four springs of the penalty's stiffness, or the limit of friction.
TEST(Sticking, spring_does_not_feel_the_faces_it_is_led_over) {
  constexpr double kRoundoff = 1e-10;
  for (double mu : {100., 0.5})
    for (const Vector3d& turn : {Vector3d(0, 0, 0), Vector3d(0.1, 0.2, -0.3)}) {
      const auto one = forces_on_the_way(1, mu, turn), many = forces_on_the_way(7, mu, turn);
      for (std::size_t i = 0; i < one.size(); ++i) {
        EXPECT_LT((one[i] - many[i]).norm(), kRoundoff * kStiffness) << i;
        const Vector3d slip(0.03 * double(i), 0.02 * double(i), 0);
        const double limit = mu * 4 * kStiffness * kDepth, spring = 4 * kStiffness * slip.norm();
        EXPECT_NEAR(one[i].head<2>().norm(), std::min(spring, limit), kRoundoff * kStiffness) << i;
      }
    }
}

}  // namespace
}  // namespace elastogear::contact::stick_test
