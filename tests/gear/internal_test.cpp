// Geometry of internal pairs: a pinion in a ring.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "elastogear/gear/cylindrical.h"
#include "elastogear/gear/flank.h"
#include "internal_drives.h"
#include "mesh_checks.h"

namespace elastogear::gear::internal_test {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;
using std::numbers::pi;
const Toothing& pinion_of(const CylindricalGeometry& g) { return g.gear[g.gear[0].internal ? 1 : 0]; }
const Toothing& ring_of(const CylindricalGeometry& g) { return g.gear[g.gear[0].internal ? 0 : 1]; }

// DIN 3960 and ISO 21771 with negative teeth of the ring: inv alpha_wt = inv alpha_t + 2 (x_1 + x_2) tan
// alpha_n / (z_1 + z_2), a = (z_1 + z_2) m_t cos alpha_t / (2 cos alpha_wt) < 0, and the length of the path
// of contact is that of the pinion's addendum path, less that of the ring, less a sin alpha_wt.
TEST(InternalPair, has_the_centre_distance_and_contact_ratio_of_the_standard) {
  for (const CylindricalDrive& d : {spur_ring(), helical_ring(), driving_ring()}) {
    const CylindricalGeometry g = derive(d);
    const Toothing &t_1 = pinion_of(g), &t_2 = ring_of(g);
    const double alpha_t = std::atan(std::tan(20 * kRadPerDegree) / std::cos(d.beta)), z = t_1.z - t_2.z;
    const double x = d.gears[0].x + d.gears[1].x, m_t = d.m_n / std::cos(d.beta);
    const double alpha_wt = g.pair[0].alpha_wt, a = z * m_t * std::cos(alpha_t) / (2 * std::cos(alpha_wt));
    EXPECT_NEAR(involute(alpha_wt), involute(alpha_t) + 2 * x * std::tan(20 * kRadPerDegree) / z, 1e-12);
    EXPECT_NEAR(-g.pair[0].a, a, 1e-12);
    EXPECT_NEAR(g.pair[0].j_n, kBacklash * d.m_n, 1e-12);
    const auto path = [](const Toothing& t) { return std::sqrt(t.r_a * t.r_a - t.r_b * t.r_b); };
    EXPECT_NEAR(g.pair[0].epsilon_alpha,
                (path(t_1) - path(t_2) - a * std::sin(alpha_wt)) / (pi * m_t * std::cos(alpha_t)), 1e-12);
    if (d.beta != 0) {
      EXPECT_NEAR(t_1.p / t_2.p, static_cast<double>(t_1.z) / t_2.z, 1e-12);  // one hand
    }
    EXPECT_NEAR(t_2.r_f - t_2.r, (1.25 - d.gears[t_2.z == d.gears[0].z ? 0 : 1].x) * d.m_n, 1e-15);
    for (double c : g.pair[0].c) EXPECT_GE(c, kLeastClearance * d.m_n - 1e-12);
    EXPECT_NEAR((g.axis[1] - g.axis[0]).norm(), g.pair[0].a, 1e-15);
  }
}

// The thickness on the pitch circle is the standard's, and the tooth grows outwards by what its space loses.
TEST(InternalTooth, and_its_space_fill_the_pitch) {
  const CylindricalDrive d = spur_ring();
  const CylindricalGeometry g = derive(d);
  const Toothing& t = g.gear[1];
  const double space = pi / t.z - psi(t, t.r);  // of an external tooth of the same involute, half of it
  for (double r : {t.r_a, t.r, t.r_form}) {
    const double as_external = space + involute(std::acos(t.r_b / t.r)) - involute(std::acos(t.r_b / r));
    EXPECT_NEAR(psi(t, r) + as_external, pi / t.z, 1e-15);
  }
  EXPECT_NEAR(2 * t.r * psi(t, t.r), g.s_n[1], 1e-15);
  EXPECT_GT(psi(t, t.r_form), psi(t, t.r_a));
}

TEST(InternalFlank, has_the_gradient_of_its_distance_as_normal_and_is_met_along_lines) {
  const CylindricalGeometry g = derive(helical_ring());
  const Toothing& t = g.gear[1];
  const double h = 1e-7;
  for (int side : {-1, 1}) {
    const Flank flank{1, side};
    const double theta = tooth_angle(t, 1) + 1e-3 / t.p + side * psi(t, t.r);
    const Vector3d on(t.r * std::cos(theta), t.r * std::sin(theta), 1e-3), n = flank_normal(t, flank, on);
    EXPECT_LT(n.head<2>().dot(on.head<2>()), 0) << "looks inwards";
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(n[i],
                  (flank_distance(t, 1, side, on + h * Vector3d::Unit(i)) -
                   flank_distance(t, 1, side, on - h * Vector3d::Unit(i))) /
                      (2 * h),
                  1e-6);
    for (double s : {-5e-5, 0.0, 8e-5}) {
      EXPECT_NEAR(flank_distance(t, 1, side, on + s * n), s, 1e-14);  // the exact distance
      EXPECT_NEAR(flank_distance_along(t, flank, on - s * n, n), s, 1e-14);
    }
  }
}

Vector3d to_body(const CylindricalGeometry& g, int i, double angle, const Vector3d& x) {
  return Eigen::AngleAxisd(-angle, Vector3d::UnitZ()) * (x - Vector3d(g.axis[i][0], g.axis[i][1], 0));
}

// Unit direction from the pinion to the pitch point, where its teeth are deepest in the ring.
double to_pitch_point(const CylindricalDrive& d) {
  return d.pairs[0].direction + (d.gears[1].internal ? pi : 0);
}

// A normal through a point of the line of action meets both flanks there. The first gear's left flank carries
// on the drive side, and the other side of the second one's teeth.
void expect_touching_flanks(const CylindricalDrive& d, bool drive_side) {
  const CylindricalGeometry g = derive(d);
  const double alpha_wt = g.pair[0].alpha_wt, up = to_pitch_point(d);
  const int inner = d.gears[1].internal ? 0 : 1, side = drive_side ? 1 : -1, own = inner == 0 ? side : -side;
  const Toothing& t = g.gear[inner];
  for (double roll : {0.0, 0.13, 0.5, 0.77, 3.2}) {
    const auto angle = angles(d, g, roll, drive_side);
    for (double s : {0.2, 0.5, 1.1})
      for (double z : {-4e-3, 0.0, 2e-3}) {
        const double begin = up - own * alpha_wt, xi = s * t.r_b * std::tan(alpha_wt);
        const Vector2d x = g.axis[inner] + t.r_b * Vector2d(std::cos(begin), std::sin(begin)) +
                           own * xi * Vector2d(-std::sin(begin), std::cos(begin));
        double sum = 0;
        for (int i : {0, 1}) {
          const int of = i == 0 ? side : -side;
          double least = 1;
          for (int tooth = 0; tooth < g.gear[i].z; ++tooth) {
            const double off = flank_distance(g.gear[i], tooth, of, to_body(g, i, angle[i], {x[0], x[1], z}));
            if (std::abs(off) < std::abs(least)) least = off;
          }
          sum += least;
        }
        EXPECT_NEAR(std::remainder(sum, g.p_bn), 0, 1e-12) << "roll " << roll << ", " << s << ", " << z;
      }
  }
}

TEST(InternalPair, is_conjugate_at_any_roll_angle) {
  for (bool drive_side : {true, false}) {
    expect_touching_flanks(spur_ring(), drive_side);
    expect_touching_flanks(helical_ring(), drive_side);
    expect_touching_flanks(driving_ring(), drive_side);
  }
}

TEST(InternalPair, turns_in_one_sense_in_the_ratio_of_its_teeth) {
  const CylindricalDrive d = spur_ring();
  const CylindricalGeometry g = derive(d);
  const auto at = angles(d, g, 0.2), later = angles(d, g, 1.2);
  EXPECT_NEAR(later[0] - at[0], 2 * pi / 21, 1e-12);
  EXPECT_NEAR(later[1] - at[1], 2 * pi / 72, 1e-12);
}

// The outline of one tooth and its fillets, in the plane z = 0 of the body frame.
std::vector<Vector3d> outline(const CylindricalDrive& d, const CylindricalGeometry& g, int i) {
  constexpr int kPoints = 40;
  const Toothing& t = g.gear[i];
  std::vector<Vector3d> points;
  for (int k = 0; k <= kPoints; ++k) {
    const double r = std::lerp(t.r_form, t.r_a, static_cast<double>(k) / kPoints);
    for (double half : {-psi(t, r), psi(t, r)})
      points.emplace_back(r * std::cos(t.theta_1 + half), r * std::sin(t.theta_1 + half), 0);
  }
  const mesh::Mesh mesh = cylindrical_mesh(d, g, i, cylindrical_counts(d, g, i, Size::small));
  for (int node : mesh::node_set(mesh, "root_01"))
    if (std::abs(mesh.X(2, node)) < 1e-9) points.push_back(mesh.X.col(node));
  return points;
}

// m, how deep the teeth of the gears are in each other while they roll by; < 0: apart, by no more than the
// backlash.
double overlap(const CylindricalDrive& d, const CylindricalGeometry& g) {
  double deepest = -1;
  for (int i : {0, 1}) {
    const Toothing& mate = g.gear[1 - i];
    const auto points = outline(d, g, i);
    for (double roll = -0.5 * d.gears[0].z; roll < 0.5 * d.gears[0].z; roll += 0.023) {
      const auto angle = angles(d, g, roll);
      const Eigen::Matrix2d turn(Eigen::Rotation2Dd(angle[i] - angle[1 - i])),
          back(Eigen::Rotation2Dd(-angle[1 - i]));
      for (const Vector3d& point : points) {
        const Vector2d x = turn * point.head<2>() + back * (g.axis[i] - g.axis[1 - i]);
        const double r = x.norm(), outwards = mate.sign();
        if (outwards * (r - mate.r_a) > 0 || outwards * (r - mate.r_form) < 0) continue;
        const double of_tooth = std::atan2(x[1], x[0]) - mate.theta_1;
        const double away = std::abs(std::remainder(of_tooth, 2 * pi / mate.z)) - psi(mate, r);
        deepest = std::max(deepest, -away * mate.r_b);
      }
    }
  }
  return deepest;
}

CylindricalDrive narrow(int teeth_between) {
  return internal_pair(2 * kMillimetre, 0, external_gear("pinion", 30, 0, 10 * kMillimetre),
                       internal_gear("ring", 30 + teeth_between, 0, 10 * kMillimetre));
}

TEST(InternalPair, keeps_teeth_out_of_each_other_around_the_whole_ring) {
  for (const CylindricalDrive& d :
       {spur_ring(), driving_ring(), narrow(5), narrow(7), narrow(8), narrow(16)}) {
    const CylindricalGeometry g = derive(d);
    EXPECT_LE(overlap(d, g), 1e-9);  // m
    EXPECT_GT(overlap(d, g), -1e-6) << "the flanks touch";
  }
}

// With a few teeth more than the pinion's the tips meet on their way in and out, and are shorter than that by
// no more than it takes.
TEST(InternalPair, of_few_teeth_between_has_the_longest_tips_that_do_not_meet) {
  for (int teeth_between : {5, 6}) {
    const CylindricalDrive d = narrow(teeth_between);
    CylindricalGeometry g = derive(d);
    g.gear[1].r_a -= 0.02 * kMillimetre;
    EXPECT_GT(overlap(d, g), 1e-6) << teeth_between;
  }
}

}  // namespace
}  // namespace elastogear::gear::internal_test
