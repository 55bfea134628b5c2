// Flank forms of worms against their tools.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "elastogear/base/error.h"
#include "elastogear/gear/flank.h"
#include "mesh_checks.h"
#include "worm_designs.h"

namespace elastogear::gear::thread_form_test {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

constexpr double kExact = 1e-7;  // m

// Distance to the flank that bounds a space at larger z: tooth 0's left one. x: with the middle of the space
// at z = 0 on the x axis.
double distance(const Toothing& t, const Vector3d& x) {
  const double turn = tooth_angle(t, 0) + pi / t.z;
  return flank_distance(
      t, 0, 1,
      {std::cos(turn) * x[0] - std::sin(turn) * x[1], std::sin(turn) * x[0] + std::cos(turn) * x[1], x[2]});
}

// m, from x in the middle of the space along `across` to the flank.
double half_width(const Toothing& t, const Vector3d& x, const Vector3d& across) {
  double low = 0, high = pi * std::abs(t.p) / t.z;
  for (int i = 0; i < 60; ++i) {
    const double s = (low + high) / 2;
    (distance(t, x + s * across) > 0 ? low : high) = s;
  }
  return low;
}

struct Frame {
  Vector3d along, across;  // the helix at the pitch cylinder, and its normal in the tangent plane
};
Frame frame(double gamma) {
  return {{0, std::cos(gamma), std::sin(gamma)}, {0, -std::sin(gamma), std::cos(gamma)}};
}

class ThreadForm : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Starts, ThreadForm, testing::Values(1, 2, 4));

TEST_P(ThreadForm, ZA_is_straight_in_the_axial_section) {
  const Design d = worm_design(FlankForm::ZA, GetParam());
  const Geometry g = derive(d);
  for (double r = g.worm.r_f; r < g.worm.r_a; r += 0.3e-3)
    EXPECT_NEAR(half_width(g.worm, {r, 0, 0}, Vector3d::UnitZ()) -
                    half_width(g.worm, {g.worm.r, 0, 0}, Vector3d::UnitZ()),
                (r - g.worm.r) * std::tan(d.alpha_n) / std::cos(g.gamma), 1e-12);
}

TEST_P(ThreadForm, ZN_is_straight_in_the_normal_section_of_the_space) {
  const Design d = worm_design(FlankForm::ZN, GetParam());
  const Geometry g = derive(d);
  const Vector3d across = frame(g.gamma).across;
  const double middle = half_width(g.worm, {g.worm.r, 0, 0}, across);
  for (double r = g.worm.r_form; r < g.worm.r_a; r += 0.3e-3)
    EXPECT_NEAR(half_width(g.worm, {r, 0, 0}, across) - middle, (r - g.worm.r) * std::tan(d.alpha_n), 1e-12);
}

// The circles of the cutter's cone, and how deep each enters the thread at the place where it is deepest.
double least_distance(const Design& d, const Geometry& g, double pitch_width, double radius) {
  const Frame f = frame(g.gamma);
  const double axis = g.worm.r_f + d.cutter_diameter / 2;
  const double eta = pitch_width + (axis - radius - g.worm.r) * std::tan(d.alpha_n);
  double least = 1;
  for (int i = -4000; i <= 4000; ++i) {
    const double beta = i * 1e-4;
    const Vector3d x =
        Vector3d(axis - radius * std::cos(beta), 0, 0) + radius * std::sin(beta) * f.along + eta * f.across;
    if (x.head<2>().norm() < g.worm.r_a) least = std::min(least, distance(g.worm, x));
  }
  return least;
}

TEST_P(ThreadForm, ZK_is_what_the_cone_of_the_cutter_leaves) {
  Design d = worm_design(FlankForm::ZK, GetParam());
  d.cutter_diameter = 60e-3;
  const Geometry g = derive(d);
  const double middle = d.cutter_diameter / 2 - d.dedendum;  // m, radius that reaches the pitch cylinder
  double low = 0, high = g.p_x / 2;
  for (int i = 0; i < 40; ++i) {
    const double width = (low + high) / 2;
    (least_distance(d, g, width, middle) > 0 ? low : high) = width;
  }
  for (double q = -0.9; q < 0.95; q += 0.2)
    EXPECT_NEAR(least_distance(d, g, low, middle + q * d.addendum), 0, kExact) << q;
}

TEST(ThreadForms, have_the_thickness_of_the_design_at_the_pitch_cylinder) {
  for (FlankForm form : {FlankForm::ZA, FlankForm::ZN, FlankForm::ZI, FlankForm::ZK}) {
    const Geometry g = derive(worm_design(form, 2));
    EXPECT_NEAR(2 * g.worm.p * psi(g.worm, g.worm.r) * std::cos(g.gamma), g.s_n, 1e-14);
  }
}

// ISO 10828: with a cutter of no curvature and no lead all forms are one; by the same design they differ.
TEST(ThreadForms, differ_from_each_other) {
  const FlankForm forms[] = {FlankForm::ZA, FlankForm::ZN, FlankForm::ZI, FlankForm::ZK};
  for (FlankForm a : forms)
    for (FlankForm b : forms) {
      if (a == b) continue;
      const Geometry g = derive(worm_design(a, 4)), h = derive(worm_design(b, 4));
      EXPECT_GT(std::abs(psi(g.worm, g.worm.r_a) - psi(h.worm, h.worm.r_a)) * g.worm.p, 1e-6);
    }
}

TEST(ThreadForms, are_those_of_the_meshes_of_either_hand) {
  for (Hand hand : {Hand::right, Hand::left})
    for (FlankForm form : {FlankForm::ZA, FlankForm::ZN, FlankForm::ZI, FlankForm::ZK})
      for (int starts : {1, 3}) {
        Design d = worm_design(form, starts);
        d.hand = hand;
        const Geometry g = derive(d);
        EXPECT_EQ(g.worm.p > 0, hand == Hand::right);
        const mesh::Mesh mesh = worm_mesh(d, worm_counts(Size::tiny, starts));
        expect_conforming(mesh);
        expect_good_cells(mesh);
        for (int i = 0; i < starts; ++i) {
          const std::string name = "thread_" + std::to_string(i + 1);
          expect_flank(mesh, name + "_left", g.worm, i, 1);
          expect_flank(mesh, name + "_right", g.worm, i, -1);
        }
      }
}

TEST(ThreadForms, normals_are_gradients_of_the_distance_on_the_flank) {
  const double h = 1e-7;
  for (FlankForm form : {FlankForm::ZA, FlankForm::ZN, FlankForm::ZK}) {
    const Geometry g = derive(worm_design(form, 2));
    for (int side : {-1, 1})
      for (double r : {g.worm.r_form, g.worm.r, g.worm.r_a}) {
        const double theta = tooth_angle(g.worm, 1) + 1e-3 / g.worm.p + side * psi(g.worm, r);
        const Vector3d x(r * std::cos(theta), r * std::sin(theta), 1e-3),
            n = flank_normal(g.worm, {1, side}, x);
        for (int i = 0; i < 3; ++i)
          EXPECT_NEAR(n[i],
                      (flank_distance(g.worm, 1, side, x + h * Vector3d::Unit(i)) -
                       flank_distance(g.worm, 1, side, x - h * Vector3d::Unit(i))) /
                          (2 * h),
                      1e-6);
      }
  }
}

}  // namespace
}  // namespace elastogear::gear::thread_form_test
