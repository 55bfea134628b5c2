// Contact against H. Hertz. Line contact of a rigid cylinder on an elastic block in plane strain: peak
// pressure and half width follow from the total force, however far away the block is held. Point contact of
// two elastic spheres: force, peak pressure and radius follow from the approach.
#include <gtest/gtest.h>

#include <cstdio>
#include <numbers>

#include "../contact/surfaces.h"
#include "../figures.h"
#include "box_body.h"
#include "contact_bodies.h"
#include "elastogear/contact/face.h"
#include "elastogear/dynamics/static.h"

namespace elastogear::hertz_test {
using namespace dynamics;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kE = 2e9, kNu = 0.3, kRadius = 1, kDepth = 0.003;  // Pa, -, m, m

// 1 x 2 m, one cell of size h thick, x <= 0; held at x = -1 m and nowhere free to move along z.
std::shared_ptr<const model::ElasticBody> block(int cells) {
  const double h = 2.0 / cells;
  const test::BoxSpec spec{.corner = {-1, -1, 0},
                           .size = {1, 2, h},
                           .cells = {cells / 2, cells, 1},
                           .material = {kE, kNu, 1000},
                           .held = [](const Vector3d& X, int d) { return d == 2 || X.x() < -1 + 1e-9; }};
  return std::make_shared<model::ElasticBody>(test::make_box(spec, model::Basis::full));
}

// Its underside touches x = 0 from above when depth = 0.
model::Surface cylinder(double depth) {
  return contact::test::flipped(contact::test::grid(200, 1, [=](double u, double v) {
    const double phi = 0.8 * (u - 0.5);
    return Vector3d(kRadius - depth - kRadius * std::cos(phi), kRadius * std::sin(phi), 4 * v - 2);
  }));
}

struct LineErrors {
  double peak, width;  // relative
};

LineErrors line_errors(int cells, contact::SlavePoints points) {
  const auto body = block(cells);
  PairSetup pair{"block:cylinder", {0, 1}, {}};
  pair.settings.stiffness = 20 * body->surface.c_f[0];
  pair.settings.surface = contact::ContactSurface::smooth;
  pair.settings.depth = 2 * kDepth;
  pair.settings.points = points;
  System system(
      {{.name = "block", .body = body}, {.name = "cylinder", .body = test::rigid_with(cylinder(kDepth))}},
      {pair});
  const model::PairState state =
      test::state_at_rest(system, test::equilibrium(system, system.initial_position())).pairs[0];
  const double thickness = 2.0 / cells, W = state.force.x() / thickness, E_star = kE / (1 - kNu * kNu);
  // The pressure that a node has on faces falls to zero at the next nodes: it has a second moment of its own.
  const double own = points == contact::SlavePoints::faces ? thickness * thickness / 6 : 0;
  double moment = 0, total = 0;
  for (const model::ContactRecord& c : state.contacts) {
    const double y = body->surface.X(1, c.slave_node);
    moment += std::abs(c.f.x()) * (y * y + own);
    total += std::abs(c.f.x());
  }
  const double peak = std::sqrt(W * E_star / (std::numbers::pi * kRadius)),
               width = std::sqrt(4 * W * kRadius / (std::numbers::pi * E_star));
  return {state.total.pressure / peak - 1, 2 * std::sqrt(moment / total) / width - 1};
}

class Hertz : public testing::TestWithParam<contact::SlavePoints> {};

TEST_P(Hertz, peak_pressure_and_half_width_of_a_line_contact_converge) {
  constexpr double kDiscretisation = 0.01;  // with 4.7 cells over the half width
  LineErrors last{1, 1};
  for (int cells : {60, 120, 240}) {
    const LineErrors error = line_errors(cells, GetParam());
    std::printf("line contact, %d cells: peak pressure %+.2f %%, half width %+.2f %%\n", cells,
                100 * error.peak, 100 * error.width);
    EXPECT_LT(std::abs(error.peak), std::abs(last.peak) / 2);
    EXPECT_LT(std::abs(error.width), std::max(std::abs(last.width) / 2, kDiscretisation));
    last = error;
  }
  const std::string of = "rigid cylinder on a block";
  test::figure({of, "peak pressure", "%"}, last.peak, kDiscretisation);
  test::figure({of, "half width", "%"}, last.width, kDiscretisation);
}

// m, by which the cylinder enters the block without a penalty, at nodes and at 10 x 10 samples of each face.
struct Entered {
  double nodes = 0, samples = 0;
};

Entered entered(int cells) {
  const auto body = block(cells);
  PairSetup pair{"block:cylinder", {0, 1}, {}};
  pair.settings.law = contact::ContactLaw::unilateral;
  std::vector<BodySetup> setups{{.name = "block", .body = body},
                                {.name = "cylinder", .body = test::rigid_with(cylinder(0))}};
  setups[1].joint = {.type = body::JointType::prismatic, .axis = {-1, 0, 0}};
  setups[1].translation.drive = still_drive(0, kDepth);
  System system(setups, {pair});
  contact::SurfaceState state;
  solve_static(system, {4}, [&](const model::Snapshot& snapshot) {
    state = contact::surface_state(body->surface, {snapshot.bodies[0].q, Vector3d::Zero(), {}});
  });
  const auto depth = [](const Vector3d& x) {
    return kRadius - std::hypot(x.x() - (kRadius - kDepth), x.y());
  };
  const auto at = [](int i) { return -0.9 + 0.2 * i; };
  Entered result;
  for (const auto& x : state.x_B.colwise()) result.nodes = std::max(result.nodes, depth(x));
  for (const auto& face : body->surface.face.colwise())
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector4d N = contact::shape(4, at(i % 10), at(i / 10)).N;
      result.samples = std::max(result.samples, depth(state.x_B(Eigen::all, face) * N));
    }
  return result;
}

TEST(LineContact, lets_nothing_in_between_nodes_but_with_the_square_of_their_distance) {
  const Entered coarse = entered(60), fine = entered(120);
  for (const Entered& now : {coarse, fine}) {
    std::printf("%.2g m at nodes, %.3g m at samples between them\n", now.nodes, now.samples);
    EXPECT_LT(now.nodes, 1e-7);
  }
  EXPECT_NEAR(std::log2(coarse.samples / fine.samples), 2, 0.1);
}

// ---- two spheres

// Two equal ones; radius and peak pressure by Hertz. By symmetry: of only one and the plane between them, for
// surfaces so steep that Newton's method needs it.
struct Spheres {
  double E, nu, R, approach;  // Pa, -, m, m
  double radius, pressure;    // m, Pa
  bool by_symmetry;

  double force() const { return 2. / 3 * std::numbers::pi * pressure * radius * radius; }
};

struct PointErrors {
  double force, radius, pressure;  // relative
};

BodySetup upper_half(const Spheres& spheres, std::shared_ptr<const model::ElasticBody> sphere) {
  BodySetup upper{.name = "upper", .body = std::move(sphere)};
  upper.joint.r_WB0 = {0, 0, -spheres.approach};
  upper.joint.R_WB0 << 0, 1, 0, 1, 0, 0, 0, 0, -1;  // upside down, on the same quarter
  if (!spheres.by_symmetry) return upper;
  const double l = 4 * spheres.radius;
  upper.body = test::rigid_with(contact::test::flipped(contact::test::plane(1, 1, l, l)));
  upper.joint.r_WB0 = {-l / 2, -l / 2, -spheres.approach / 2};
  upper.joint.R_WB0.setIdentity();
  return upper;
}

// A quarter, with `cells` over the contact radius.
PointErrors point_errors(const Spheres& spheres, double cells, contact::SlavePoints points) {
  constexpr double kReach =
      1.4;  // the surface's over the contact radius, so that it holds all of the contact
  const double h = spheres.radius / cells;
  const auto body =
      test::half_space({spheres.E, spheres.nu, h, static_cast<int>(std::ceil(kReach * cells))}, spheres.R);
  PairSetup pair{"lower:upper", {0, 1}, {}};
  pair.settings.stiffness = 100 * spheres.E / h;
  pair.settings.depth = 2 * spheres.approach;
  pair.settings.full_tangent = false;
  pair.settings.points = points;
  pair.settings.surface = contact::ContactSurface::facets;  // for whole Newton steps from far away
  System system({{.name = "lower", .body = body}, upper_half(spheres, body)}, {pair});
  const model::PairState state =
      test::state_at_rest(system, test::equilibrium(system, system.initial_position())).pairs[0];
  const double own = points == contact::SlavePoints::faces ? h * h / 3 : 0;  // as in line_errors, in x and y
  double moment = 0, total = 0;
  for (const model::ContactRecord& c : state.contacts) {
    moment += std::abs(c.f.z()) * (body->surface.X.col(c.slave_node).head<2>().squaredNorm() + own);
    total += std::abs(c.f.z());
  }
  return {4 * total / spheres.force() - 1, std::sqrt(2.5 * moment / total) / spheres.radius - 1,
          state.total.pressure / spheres.pressure - 1};
}

using Sphere = std::pair<Spheres, contact::SlavePoints>;
class TwoSpheres : public testing::TestWithParam<Sphere> {};

TEST_P(TwoSpheres, force_radius_and_peak_pressure_converge) {
  constexpr double kDiscretisation = 2e-3;  // with 10 cells over the radius
  constexpr double kClose = 3e-3;           // pressures over faces are as near as that from 2.5 cells on
  const auto& [spheres, points] = GetParam();
  const bool faces = points == contact::SlavePoints::faces;
  PointErrors last{1, 1, 1};
  for (double cells : {2.5, 5., 10.}) {
    const PointErrors error = point_errors(spheres, cells, points);
    std::printf("R = %g m, %g cells, %s: radius %+.2f %%, peak pressure %+.2f %%, force %+.2f %%\n",
                spheres.R, cells, faces ? "faces" : "nodes", 100 * error.radius, 100 * error.pressure,
                100 * error.force);
    EXPECT_LT(std::abs(error.radius), std::abs(last.radius) / 2);
    EXPECT_LT(std::abs(error.pressure), faces ? kClose : std::abs(last.pressure));
    last = error;
  }
  test::figure({"two spheres", "force at equal approach", "%"}, last.force, kDiscretisation);
  EXPECT_LT(std::abs(last.radius), faces ? 2 * kDiscretisation : kDiscretisation);
  EXPECT_LT(std::abs(last.pressure), kDiscretisation);
}

INSTANTIATE_TEST_SUITE_P(Points, Hertz,
                         testing::Values(contact::SlavePoints::nodes, contact::SlavePoints::faces));

// Over faces Newton's method needs symmetry for the flat pair, too.
constexpr Spheres kFlat{1.40625e7, 0.25, 2, 0.01, 0.1, 477465, false},
    kFlatBySymmetry{1.40625e7, 0.25, 2, 0.01, 0.1, 477465, true},
    kSteep{20e9, 0.3, 0.05, 4e-3, 0.01, 2798.3e6, true};

INSTANTIATE_TEST_SUITE_P(Hertz, TwoSpheres,
                         testing::Values(Sphere{kFlat, contact::SlavePoints::nodes},
                                         Sphere{kSteep, contact::SlavePoints::nodes},
                                         Sphere{kFlatBySymmetry, contact::SlavePoints::faces},
                                         Sphere{kSteep, contact::SlavePoints::faces}));

}  // namespace
}  // namespace elastogear::hertz_test
