// Transmission error of the rigid worm drive: where the wheel is when the smallest gap is closed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "../figures.h"
#include "worm_drive.h"

namespace elastogear::contact::transmission_test {
namespace {

using test::WormDrive;

constexpr double kPi = 3.14159265358979323846;

// Sides of the master's flanks, by the slave's side, that carry when the wheel is ahead.
constexpr int kCarries[2] = {+1, -1};

struct Points {
  ContactSurface surface;
  SlavePoints points;
};

Pair pair_of(const WormDrive& drive, const Points& p) {
  Settings settings;
  settings.law = ContactLaw::unilateral;
  settings.surface = p.surface;
  settings.points = p.points;
  settings.two_pass = p.points == SlavePoints::nodes;
  settings.depth = 0.4e-3;
  settings.extension = 0;
  settings.stiffness = 1e14;
  return Pair(drive.worm.surface, drive.wheel.surface, settings, {}, {&drive.worm.exact, &drive.wheel.exact});
}

const test::Flank& master_flank(const WormDrive& drive, const ContactPoint& c) {
  return (c.slave_side == 1 ? drive.worm : drive.wheel).flank[c.face];
}

// Of the flanks that carry.
double smallest_gap(Pair& pair, const WormDrive& drive, double phi_1, double ahead) {
  double gap = 1;
  for (const ContactPoint& c :
       pair.detect(test::worm_motion(drive, phi_1), test::wheel_motion(drive, phi_1, ahead)))
    if (master_flank(drive, c).side == kCarries[c.slave_side]) gap = std::min(gap, c.g_n);
  return gap;
}

// rad, by which the wheel is ahead of where it would be without error, at the first touch.
double touching(Pair& pair, const WormDrive& drive, double phi_1) {
  constexpr double kBefore = 5e-6, kAfter = 60e-6, kTolerance = 1e-10;  // m
  double apart = test::pressed(drive, -kBefore), within = test::pressed(drive, kAfter);
  const double tolerance = test::pressed(drive, kTolerance) - test::pressed(drive, 0);
  EXPECT_GT(smallest_gap(pair, drive, phi_1, apart), 0);
  EXPECT_LT(smallest_gap(pair, drive, phi_1, within), 0);
  while (within - apart > tolerance) {
    const double middle = 0.5 * (apart + within);
    (smallest_gap(pair, drive, phi_1, middle) > 0 ? apart : within) = middle;
  }
  return apart;
}

// m, at the wheel's pitch circle, from the smallest to the largest over a pitch.
double transmission_error(const WormDrive& drive, const Points& p) {
  constexpr int kAngles = 48;
  Pair pair = pair_of(drive, p);
  double least = 1, most = -1;
  for (int i = 0; i < kAngles; ++i) {
    const double ahead = touching(pair, drive, 2 * kPi / drive.design.z1 * i / kAngles);
    least = std::min(least, ahead), most = std::max(most, ahead);
  }
  return (most - least) * drive.geometry.wheel.r;
}

// Between nodes that touch, exact flanks enter each other by the square of their distance over the radii.
TEST(Transmission, of_a_perfect_rigid_drive_has_no_error_on_the_exact_flanks_of_the_coarsest_mesh) {
  const double on_facets = 20e-6, on_smooth = 8e-6, on_exact = 0.1e-6;  // m
  const WormDrive drive = test::worm_drive(1);
  const double facets = transmission_error(drive, {ContactSurface::facets, SlavePoints::nodes}),
               smooth = transmission_error(drive, {ContactSurface::smooth, SlavePoints::minima}),
               exact = transmission_error(drive, {ContactSurface::exact, SlavePoints::minima});
  std::printf("transmission error, um: facets %.3g, smooth %.3g, exact %.3g\n", 1e6 * facets, 1e6 * smooth,
              1e6 * exact);
  EXPECT_GT(facets, on_facets);
  EXPECT_LT(smooth, on_smooth);
  elastogear::test::figure(
      {"rigid worm drive, minimum-gap points, exact flanks", "transmission error, peak to peak", "µm"}, exact,
      on_exact);
}

}  // namespace
}  // namespace elastogear::contact::transmission_test
