// A punch is dragged slowly over a rough plate: over ridges, valleys, peaks and warped faces.
#include <gtest/gtest.h>

#include "../contact/surfaces.h"
#include "contact_bodies.h"
#include "elastogear/dynamics/simulate.h"

namespace elastogear::ridge_test {
using namespace dynamics;
using Eigen::Vector3d;

namespace {

constexpr int kFaces = 60;
constexpr double kLength = 1.2, kHeight = 8e-4;               // m, of the plate and of its roughness
constexpr double kMass = 1, kLoad = 100, kSpring = 1e6;       // kg, N, N/m: of all nodes of the punch
constexpr double kSpeed = 0.05, kEnd = 4;                     // m/s, s
constexpr double kSteepest = 2 * kHeight * kFaces / kLength;  // slope of a face along its sides

model::Surface rough_plate() {
  contact::test::Random random(1);
  return contact::test::grid(kFaces, kFaces, [&](double u, double v) {
    return Vector3d(kLength * (u - 0.5), kLength * (v - 0.5), random.uniform(-kHeight, kHeight));
  });
}

// The plate moves below the punch, which may only move up and down.
System dragging() {
  constexpr double kSide = 1e-3;
  const model::Surface plane = contact::test::plane(1, 1, kSide, kSide);
  BodySetup punch{.name = "punch", .body = test::rigid_with(contact::test::flipped(plane), kMass)};
  punch.joint = {.type = body::JointType::prismatic, .axis = {0, 0, 1}, .r_WB0 = {0, 0, kHeight}};
  punch.translation.load = constant_signal(-kLoad);
  BodySetup plate{.name = "plate", .body = test::rigid_with(rough_plate())};
  plate.joint = {.type = body::JointType::prismatic, .axis = Vector3d(1, 0.37, 0).normalized()};
  plate.translation.drive = speed_drive(0, kSpeed);
  PairSetup pair{"punch:plate", {0, 1}, {}};
  pair.settings.stiffness = kSpring / 4;
  pair.settings.penalty = contact::Penalty::per_node;
  pair.settings.depth = 2 * kHeight;
  pair.settings.hysteresis = 4;
  return System({punch, plate}, {pair});
}

// Where the path has a kink the punch must change its velocity by at most twice the steepest slope times the
// speed, which costs its spring that times sqrt(m c).
TEST(RoughPlate, gives_no_force_spike_beyond_the_kinks_of_the_path) {
  constexpr double kSettled = 0.3;  // s
  const double bound = kLoad + 2 * std::hypot(1, 1) * kSteepest * kSpeed * std::sqrt(kMass * kSpring);
  double largest = 0, smallest = kLoad;
  System system = dragging();
  const RunSummary summary =
      simulate(system, {.dt = 4e-4, .end_time = kEnd, .rho_inf = 0.9}, [&](const model::Snapshot& s) {
        if (s.time < kSettled) return;
        largest = std::max(largest, -s.pairs[0].force.z());
        smallest = std::min(smallest, -s.pairs[0].force.z());
      });
  EXPECT_LT(largest, bound);
  EXPECT_GT(smallest, 2 * kLoad - bound);
  EXPECT_EQ(summary.rejected_steps, 0) << "contacts flutter";
  EXPECT_LT(summary.newton_iterations, summary.steps) << "found: 0.57 a step";
}

}  // namespace
}  // namespace elastogear::ridge_test
