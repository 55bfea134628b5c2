// The local approach of flanks: its law, the half-space under pressures of a surface's nodes, and lines of
// contact beside the ellipses of H. Hertz.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
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

// Mean of 1/r of the pressure cos^2 x cos^2 y over 6 x 6 faces of a coarse plane, given by its consistent
// nodal forces, which are those of a plane with `finer` times as many faces added up.
double coarse_or_fine(int finer, double stretch) {
  constexpr int kFaces = 6, kQuadrature = 24;
  const model::Surface surface = plane(kFaces * finer, 1. / finer, stretch);
  VectorXd f = VectorXd::Zero(surface.X.cols());
  const auto pressure = [](double x) { return std::pow(std::sin(std::numbers::pi * x / kFaces), 2); };
  const int per_side = kFaces * finer + 1;
  VectorXd line = VectorXd::Zero(per_side);  // consistent forces along one direction
  for (int e = 0; e + 1 < per_side; ++e)
    for (int i = 0; i < kQuadrature; ++i) {
      const double s = (i + 0.5) / kQuadrature, p = pressure((e + s) / finer) / (finer * kQuadrature);
      line[e] += (1 - s) * p;
      line[e + 1] += s * p;
    }
  for (Eigen::Index n = 0; n < f.size(); ++n) {
    const auto at = [&](int d, double h) {
      return static_cast<Eigen::Index>(std::lround(surface.X(d, n) / h));
    };
    f[n] = line[at(0, 1. / finer)] * line[at(1, stretch / finer)];
  }
  f /= f.sum();
  HalfSpace half_space(surface);
  double sum = 0;
  for (int i = 0; i < f.size(); ++i)
    for (int j = 0; j < f.size(); ++j) sum += f[i] * f[j] * half_space.mean_inverse_distance(i, j);
  return sum;
}

// A pressure over three faces to either side is a patch that coarse faces just show.
TEST(HalfSpace, has_the_work_of_a_pressure_given_by_its_consistent_forces) {
  for (double stretch : {1., 3.}) {
    const double coarse = coarse_or_fine(1, stretch), fine = coarse_or_fine(4, stretch);
    std::printf("faces of 1 x %g: work %+.2f %%\n", stretch, 100 * (coarse / fine - 1));
    EXPECT_NEAR(coarse, fine, 5e-3 * fine);
  }
}

TEST(HalfSpace, far_away_is_that_of_a_point) {
  const model::Surface surface = plane(12, 1, 2);
  const auto n = static_cast<int>(surface.X.cols()) - 1;
  HalfSpace half_space(surface);
  EXPECT_NEAR(half_space.mean_inverse_distance(0, n), 1 / surface.X.col(n).norm(), 1e-12);
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
