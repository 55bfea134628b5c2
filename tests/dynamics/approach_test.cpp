// The local approach of flanks: its law, the half-space under pressures of a surface's nodes, and lines of
// contact beside the ellipses of H. Hertz.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>

#include "../contact/surfaces.h"
#include "contact_bodies.h"
#include "dynamics/approach/approach_law.h"
#include "dynamics/approach/half_space.h"
#include "dynamics/approach/patch_approach.h"

namespace elastogear::dynamics::approach_test {
namespace {

using Eigen::VectorXd;

TEST(ApproachLaw, goes_through_its_point_with_the_slopes_of_its_energies) {
  constexpr double kStep = 1e-3;  // N
  const ApproachLaw law{800, 5e-6, 2. / 3};
  EXPECT_NEAR(law.value(800), 5e-6, 1e-18);
  EXPECT_EQ(law.value(0), 0);
  EXPECT_EQ(law.value(-1), 0);
  for (double F : {1., 100., 800., 3000.}) {
    EXPECT_NEAR(law.slope(F), (law.value(F + kStep) - law.value(F - kStep)) / (2 * kStep),
                1e-6 * law.slope(F));
    EXPECT_NEAR(law.value(F),
                (law.complementary_energy(F + kStep) - law.complementary_energy(F - kStep)) / (2 * kStep),
                1e-6 * law.value(F));
    EXPECT_NEAR(F * law.slope(F), (law.energy(F + kStep) - law.energy(F - kStep)) / (2 * kStep),
                1e-6 * F * law.slope(F));
  }
}

TEST(ApproachLaw, of_no_force_is_none) {
  const ApproachLaw none;
  EXPECT_EQ(none.value(10), 0);
  EXPECT_EQ(none.slope(10), 0);
  EXPECT_EQ(none.energy(10), 0);
}

// A plane of n x n faces of the size h x stretch h.
model::Surface plane(int n, double h, double stretch) {
  model::Surface surface = contact::test::grid(
      n, n, [=](double u, double v) { return Eigen::Vector3d(n * h * u, n * h * stretch * v, 0); });
  elastogear::test::complete(surface);
  return surface;
}

// The number of the node at x, y.
int node_at(const model::Surface& surface, double x, double y) {
  Eigen::Index node = 0;
  (surface.X.colwise() - Eigen::Vector3d(x, y, 0)).colwise().norm().minCoeff(&node);
  return static_cast<int>(node);
}

// Mean of 1/r between the pressures of the corners at (x, y) and at `other` of a coarse plane, or between the
// same pressures as a plane with `finer` times as many faces has them.
double mean_between(int finer, double stretch, const Eigen::Vector2d& other) {
  const model::Surface surface = plane(6 * finer, 1. / finer, stretch);
  HalfSpace half_space(surface);
  const auto hat = [&](const Eigen::Vector2d& at) {
    std::map<int, double> p;
    double sum = 0;
    for (int i = 1 - finer; i < finer; ++i)
      for (int j = 1 - finer; j < finer; ++j) {
        const double weight =
            (1 - std::abs(i) / static_cast<double>(finer)) * (1 - std::abs(j) / static_cast<double>(finer));
        p[node_at(surface, at[0] + i / static_cast<double>(finer),
                  stretch * (at[1] + j / static_cast<double>(finer)))] = weight;
        sum += weight;
      }
    for (auto& [node, force] : p) force /= sum;
    return p;
  };
  const auto a = hat({3, 3}), b = hat(other);
  double mean = 0;
  for (const auto& [i, p] : a)
    for (const auto& [j, q] : b) mean += p * q * half_space.mean_inverse_distance(i, j);
  return mean;
}

// The parts of sides are many enough, of one pressure and of two that overlap or are next to each other.
TEST(HalfSpace, has_the_work_of_pressures_cut_more_finely) {
  for (double stretch : {1., 3.})
    for (double y : {3., 4., 5.}) {
      const double coarse = mean_between(1, stretch, {3, y}), fine = mean_between(4, stretch, {3, y});
      std::printf("sides of 1 x %g, corners %g apart: work %+.2f %%\n", stretch, y - 3,
                  100 * (coarse / fine - 1));
      EXPECT_NEAR(coarse, fine, 0.01 * fine);
    }
}

TEST(HalfSpace, far_away_is_that_of_a_point) {
  const model::Surface surface = plane(12, 1, 2);
  const int i = node_at(surface, 1, 2), j = node_at(surface, 11, 22);
  HalfSpace half_space(surface);
  EXPECT_NEAR(half_space.mean_inverse_distance(i, j), 1 / (surface.X.col(i) - surface.X.col(j)).norm(),
              1e-12);
}

// A quadrilateral of eight nodes alone and a triangle of six: the pressure of a corner is bilinear or linear.
TEST(HalfSpace, has_consistent_forces_on_second_order_sides) {
  model::Surface surface;
  surface.X.resize(3, 8);
  surface.X << 0, 2, 2, 0, 1, 2, 1, 0, 0, 0, 2, 2, 0, 1, 2, 1, 0, 0, 0, 0, 0, 0, 0, 0;
  surface.node = {0, 1, 2, 3, 4, 5, 6, 7};
  surface.face.resize(4, 1);
  surface.face << 4, 5, 6, 7;
  surface.side.resize(8, 1);
  surface.side << 0, 1, 2, 3, 4, 5, 6, 7;
  HalfSpace square(surface);
  const double of_square[] = {0, -1. / 9, -1. / 9, -1. / 9, 4. / 9, 2. / 9, 2. / 9, 4. / 9};
  for (const auto& [node, force] : square.pressure(0).nodal_force)
    EXPECT_NEAR(force, of_square[node], 2e-3) << node;
  EXPECT_LT((square.pressure(0).x - Eigen::Vector3d(2. / 3, 2. / 3, 0)).norm(), 1e-12);
  surface.side << 0, 1, 3, 4, 5, 7, -1, -1;
  surface.X.col(5) << 1, 1, 0;
  surface.face << 4, 5, 7, 7;
  HalfSpace triangle(surface);
  const double of_triangle[] = {0.1, -0.05, 0, -0.05, 0.4, 0.2, 0, 0.4};
  for (const auto& [node, force] : triangle.pressure(0).nodal_force)
    EXPECT_NEAR(force, of_triangle[node], 2e-3) << node;
  EXPECT_LT((triangle.pressure(0).x - Eigen::Vector3d(0.5, 0.5, 0)).norm(), 2e-3);
}

// Four equal sides bear it evenly; at an edge of the surface pressures are of one side and keep its place.
TEST(HalfSpace, spreads_a_force_over_the_corners_around_it) {
  const model::Surface surface = plane(6, 1, 2);
  HalfSpace half_space(surface);
  const int node = node_at(surface, 3, 6);
  const contact::Spread of = half_space.spread(node, Eigen::Vector3d::Zero());
  ASSERT_EQ(of.node.size(), 9U);
  for (double weight : of.weight) EXPECT_NEAR(weight, 1. / 9, 1e-12);
  const contact::Spread at_edge = half_space.spread(node_at(surface, 0, 6), Eigen::Vector3d::Zero());
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < at_edge.node.size(); ++i)
    centre += at_edge.weight[static_cast<Eigen::Index>(i)] * half_space.pressure(at_edge.node[i]).x;
  EXPECT_NEAR(at_edge.weight.sum(), 1, 1e-12);
  EXPECT_LT((centre - Eigen::Vector3d(0, 6, 0)).norm(), 1e-12);
}

// Forces along the major axis of a long ellipse; the rest of the ellipse's approach is what the gap takes.
TEST(PatchApproach, of_a_line_is_that_of_a_long_ellipse) {
  constexpr double kE = 1e11, kA = 0.2, kB = 100, kForce = 500;
  constexpr int kForces = 40;
  const model::HertzEllipse ellipse = model::hertz_ellipse(kA, kB, kE);
  const double a = ellipse.a(kForce);
  LineForces forces{VectorXd(kForces + 1), VectorXd(kForces + 1)};
  for (int i = 0; i <= kForces; ++i) {
    forces.t[i] = a * (2. * i / kForces - 1);
    forces.p[i] = 1 - std::pow(forces.t[i] / a, 2);
  }
  forces.p *= kForce / forces.p.sum();
  const LineExtent whole{-a, a, 2 * a / kForces};
  const PatchApproach line = line_approach(forces, whole, 0, 2 * kB, 1 / kE);
  const double gap = kA * forces.p.dot(forces.t.cwiseAbs2()) / kForce;
  std::printf("b / a = %.3f: line %.4g m, ellipse %.4g m\n", ellipse.k, line.approach,
              ellipse.approach(kForce) - gap);
  EXPECT_NEAR(line.approach, ellipse.approach(kForce) - gap, 0.01 * line.approach);
  forces.p *= 1.01;
  const PatchApproach more = line_approach(forces, whole, 0, 2 * kB, 1 / kE);
  EXPECT_NEAR(std::log(more.approach / line.approach) / std::log(1.01), line.m, 1e-3);
}

// An even load, by few forces at places that have nothing to do with the stations.
TEST(PatchApproach, stations_have_an_even_load_of_few_forces) {
  const LineExtent line{-1, 3, 1};
  const LineForces inside{VectorXd::LinSpaced(4, -0.5, 2.5), VectorXd::Ones(4)};
  const LineForces with_ends{VectorXd::LinSpaced(5, -1, 3), (VectorXd(5) << .5, 1, 1, 1, .5).finished()};
  for (const LineForces& forces : {inside, with_ends})
    for (int n : {1, 3, 8}) {
      const VectorXd S = station_forces(forces, line, n);
      EXPECT_LT((S - VectorXd::Constant(n, 4. / n)).cwiseAbs().maxCoeff(), 1e-12) << n;
    }
}

// A force that is parted in two at one place changes nothing; one at an end bears there alone.
TEST(PatchApproach, stations_do_not_depend_on_how_a_force_is_parted) {
  const LineExtent line{0, 4, 1};
  const LineForces one{VectorXd::Constant(1, 3.8), VectorXd::Constant(1, 10)};
  const LineForces two{VectorXd::Constant(2, 3.8), (VectorXd(2) << 9, 1).finished()};
  const VectorXd S = station_forces(one, line, 8);
  EXPECT_LT((S - station_forces(two, line, 8)).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_NEAR(S.sum(), 10, 1e-12);
  EXPECT_GT(S[7], S[4]);
  EXPECT_EQ(S[2], 0);
}

// Along the diagonal of a plane of 4 x 4 faces, of 3 x 2 m each, that begins and ends at its corners.
TEST(PatchApproach, a_line_goes_on_to_the_ends_of_the_faces_it_crosses) {
  model::Surface surface =
      contact::test::grid(4, 4, [](double u, double v) { return Eigen::Vector3d(12 * u, 8 * v, 0); });
  elastogear::test::complete(surface);
  surface.group.assign(static_cast<std::size_t>(surface.face.cols()), 0);
  const Eigen::Vector3d along = Eigen::Vector3d(3, 2, 0).normalized(), x(4.5, 3, 0.01),
                        normal = Eigen::Vector3d::UnitZ();
  const LineExtent whole = line_extent(surface, 0, x, along, normal);
  EXPECT_NEAR(whole.from, -std::hypot(4.5, 3), 1e-12);
  EXPECT_NEAR(whole.to, std::hypot(7.5, 5), 1e-12);
  EXPECT_NEAR(whole.face, std::hypot(3, 2), 1e-12);
  const LineExtent across = line_extent(surface, 0, x, Eigen::Vector3d::UnitX(), normal);
  EXPECT_NEAR(across.from, -4.5, 1e-12);
  EXPECT_NEAR(across.to, 7.5, 1e-12);
  const LineExtent none = line_extent(surface, 1, x, along, normal);
  EXPECT_EQ(none.to, none.from);
}

TEST(PatchApproach, is_an_ellipse_where_that_is_shorter_than_the_flank) {
  const model::Curvatures at{20, 200, Eigen::Vector3d::UnitX()};
  const model::HertzEllipse ellipse = model::hertz_ellipse(10, 100, 1e11);
  const double a = ellipse.a(100);
  EXPECT_TRUE(is_ellipse(at, 100, 1e-11, 3 * a));
  EXPECT_FALSE(is_ellipse(at, 100, 1e-11, a));
  EXPECT_FALSE(is_ellipse({0, 200, Eigen::Vector3d::UnitX()}, 100, 1e-11, 3 * a));
  EXPECT_NEAR(ellipse_approach(at, 100, 1e-11).approach, ellipse.approach(100), 1e-15);
}

}  // namespace
}  // namespace elastogear::dynamics::approach_test
