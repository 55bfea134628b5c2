// Fillets and meshes of internal gears.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "elastogear/base/error.h"
#include "internal_drives.h"
#include "mesh_checks.h"

namespace elastogear::gear::internal_mesh_test {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

// A tooth of the cutter: involute, and an arc that touches it and the tip circle. The arc's centre is looked
// for among points whose distance from the sampled involute is the radius.
struct CutterTooth {
  double z, r_b, r_a, rho, psi_b, centre;
  double flank(double r) const { return psi_b - involute(std::acos(std::min(1.0, r_b / r))); }
  double half_width(double r) const {
    const double r_c = r_a - rho, cosine = (r * r + r_c * r_c - rho * rho) / (2 * r * r_c);
    return r <= r_a && cosine < 1 && centre + std::acos(cosine) < flank(r) ? centre + std::acos(cosine)
                                                                           : flank(r);
  }
};

CutterTooth cutter_tooth(const CylindricalDrive& d, const CylindricalGeometry& g, int i) {
  const Toothing& t = g.gear[i];
  CutterTooth c{};
  c.z = g.cutter[i].z_0, c.rho = g.cutter[i].rho_a0 * d.m_n;
  const double r = t.r * c.z / t.z;
  c.r_b = r * std::cos(t.alpha_t), c.r_a = t.r_f - (t.r - r);
  c.psi_b = (pi * d.m_n - g.s_n[i]) / (d.m_n * c.z) + involute(t.alpha_t);
  const double r_c = c.r_a - c.rho;
  const auto distance = [&](double angle) {
    double least = 1;
    for (int k = 0; k <= 20000; ++k) {
      const double at = std::lerp(r_c, c.r_a, k / 20000.0);
      least = std::min(least, std::hypot(at * std::sin(c.flank(at)) - r_c * std::sin(angle),
                                         at * std::cos(c.flank(at)) - r_c * std::cos(angle)));
    }
    return least;
  };
  double low = 0, high = c.flank(r_c);
  for (int k = 0; k < 40; ++k) (distance((low + high) / 2) > c.rho ? low : high) = (low + high) / 2;
  c.centre = low;
  return c;
}

// How far the cutter stays away from a point of the ring's section while it rolls by, m.
double rolled_clearance(const CutterTooth& c, const Toothing& t, double angle, double radius) {
  constexpr int kPositions = 40000;
  double least = 1;
  for (int k = -kPositions; k <= kPositions; ++k) {
    const double of_ring = 2 * 2 * pi / t.z * k / kPositions, of_cutter = of_ring * t.z / c.z;
    const double at = pi / t.z - angle + of_ring;  // from the cutter's tooth when both stand at 0
    const double x = radius * std::sin(at), y = radius * std::cos(at) - (t.r - t.r * c.z / t.z);
    const double r = std::hypot(x, y);
    if (r > c.r_a || r < c.r_b) continue;
    least = std::min(least, r * (std::abs(std::atan2(x, y) - of_cutter) - c.half_width(r)));
  }
  return least;
}

void expect_swept_fillet(const CylindricalDrive& d, int i) {
  constexpr double kExact = 1e-7;  // m
  const CylindricalGeometry g = derive(d);
  const Toothing& t = g.gear[i];
  const CutterTooth c = cutter_tooth(d, g, i);
  const mesh::Mesh mesh = cylindrical_mesh(d, g, i, cylindrical_counts(d, g, i, Size::small));
  int checked = 0;
  for (int node : mesh.node_sets.at("root_01")) {
    const Vector3d x = mesh.X.col(node);
    const double angle = std::remainder(std::atan2(x[1], x[0]) - pi / 2 - x[2] / t.p, 2 * pi);
    EXPECT_LE(x.head<2>().norm(), t.r_f + 1e-12);
    if (x[2] > 0 || angle < 0 || x.head<2>().norm() > t.r_f - 1e-9) continue;
    EXPECT_NEAR(rolled_clearance(c, t, angle, x.head<2>().norm()), 0, kExact)
        << "radius " << x.head<2>().norm() << ", form " << t.r_form << ", root " << t.r_f;
    ++checked;
  }
  EXPECT_GT(checked, 5);
}

TEST(InternalFillet, is_what_the_cutter_leaves_that_rolls_by) {
  expect_swept_fillet(spur_ring(), 1);
  expect_swept_fillet(helical_ring(), 1);
  CylindricalDrive d = driving_ring();
  d.gears[0].cutter = {.z_0 = 18, .rho_a0 = 0.2};
  expect_swept_fillet(d, 0);
}

void expect_good_ring(const CylindricalDrive& d, int i, Size size) {
  const CylindricalGeometry g = derive(d);
  const mesh::Mesh mesh = cylindrical_mesh(d, g, i, cylindrical_counts(d, g, i, size));
  expect_good_cells(mesh);
  expect_conforming(mesh);
  expect_distinct_used_nodes(mesh);
  expect_flank(mesh, "tooth_02_left", g.gear[i], 1, +1);
  expect_flank(mesh, "tooth_02_right", g.gear[i], 1, -1);
  for (int node : mesh::node_set(mesh, "outer"))
    EXPECT_NEAR(mesh.X.col(node).head<2>().norm(), g.blank[i].outer_diameter / 2, 1e-12);
  EXPECT_EQ(mesh.node_sets.count("bore"), 0u);
}

TEST(InternalMesh, has_good_cells_exact_flanks_and_an_outside) {
  for (Size size : {Size::tiny, Size::small}) {
    expect_good_ring(spur_ring(), 1, size);
    expect_good_ring(helical_ring(), 1, size);
    expect_good_ring(driving_ring(), 0, size);
  }
  CylindricalDrive thick = spur_ring();
  thick.gears[1].blank.outer_diameter = 180 * kMillimetre;
  expect_good_ring(thick, 1, Size::tiny);
  EXPECT_GT(mesh::cell_set(cylindrical_mesh(thick, derive(thick), 1, {}), "body").size(), 0u);
}

// Cells fill what lies between the outside and the teeth, whose section is integrated over radii.
TEST(InternalMesh, has_the_volume_of_ring_and_teeth) {
  const CylindricalDrive d = spur_ring();
  const CylindricalGeometry g = derive(d);
  const Toothing& t = g.gear[1];
  double section = pi * (std::pow(g.blank[1].outer_diameter / 2, 2) - t.r_f * t.r_f);
  constexpr int kRings = 10000;
  for (int k = 0; k < kRings; ++k) {
    const double r = std::lerp(t.r_a, t.r_f, (k + 0.5) / kRings);
    section += 2 * psi(t, r) * t.z * r * (t.r_f - t.r_a) / kRings;
  }
  const mesh::Mesh mesh = cylindrical_mesh(d, g, 1, cylindrical_counts(d, g, 1, Size::small));
  EXPECT_NEAR(volume(mesh) / (section * 16 * kMillimetre), 1, 1e-2);  // the fillets are on top
  EXPECT_GT(volume(mesh), section * 16 * kMillimetre * 0.999);
}

// Any pair of a pinion and a ring.
CylindricalDrive random_drive(std::mt19937& random) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<>(low, high)(random);
  };
  const double m_n = between(0.5e-3, 10e-3), beta = between(0, 1) < 0.4 ? 0 : between(0, 35 * kRadPerDegree);
  const int z_1 = 12 + static_cast<int>(between(0, 29)), z_2 = z_1 + 10 + static_cast<int>(between(0, 111));
  const double width = between(4, 15) * m_n;
  return internal_pair(m_n, beta, external_gear("pinion", z_1, between(-0.5, 0.8), width),
                       internal_gear("ring", z_2, between(-0.5, 0.8), width));
}

TEST(InternalMesh, of_100_random_designs_has_good_cells) {
  std::mt19937 random(2);
  int possible = 0, refused = 0;
  while (possible < 100) {
    const CylindricalDrive d = random_drive(random);
    CylindricalGeometry g;
    try {
      g = derive(d);
    } catch (const Error&) {
      ++refused;
      continue;
    }
    if (g.pair[0].epsilon_alpha < 1.1) continue;
    ++possible;
    SCOPED_TRACE(std::to_string(g.gear[0].z) + ":" + std::to_string(g.gear[1].z) +
                 " teeth, x = " + std::to_string(d.gears[0].x) + ", " + std::to_string(d.gears[1].x));
    for (int i : {0, 1}) {
      expect_good_cells(cylindrical_mesh(d, g, i, cylindrical_counts(d, g, i, Size::tiny)));
    }
  }
  EXPECT_LT(refused, 200);
}

}  // namespace
}  // namespace elastogear::gear::internal_mesh_test
