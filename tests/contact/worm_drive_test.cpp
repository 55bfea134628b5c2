// Contact search on the exact involute flanks of the worm drive, bodies rigid.
#include <gtest/gtest.h>

#include <cstdio>
#include <map>

#include "../figures.h"
#include "contact/projection/heights.h"
#include "surfaces.h"
#include "worm_drive.h"

namespace elastogear::contact::worm_drive_test {
namespace {

using Eigen::Vector3d;
using test::Flanks;
using test::WormDrive;

constexpr double kPi = test::pi;
constexpr std::array kSurfaces{ContactSurface::facets, ContactSurface::smooth, ContactSurface::exact};
constexpr std::array kNames{"facets", "smooth", "exact"};
constexpr int kFacets = 0, kSmooth = 1, kExact = 2;
constexpr double kMargin = 0.1e-3;  // m, from the ends of a flank, where the facets end a little elsewhere
constexpr double kFeatureAngle = 30 * kPi / 180;

// One body's nodes against the other's flanks.
struct Sides {
  const Flanks &slaves, &masters;
  SurfaceMotion slave_at, master_at;

  Vector3d node(int i) const { return slave_at.R_WB * slaves.surface.X.col(i) + slave_at.r_WB; }
};

// ---- the gap

constexpr double kNear = 0.3e-3;  // m, of slave nodes whose gaps are looked at

struct GapErrors {
  double largest = 0;  // m
  double along = 0;    // m, largest against the distance along the normal of the face
  int nodes = 0;
};

Vector3d in_body(const SurfaceMotion& placed, const Vector3d& x) {
  return placed.R_WB.transpose() * (x - placed.r_WB);
}

// Of the contact's undeformed face at the closest point, in the master's BRF.
Vector3d face_normal(const model::Surface& master, const ContactPoint& c) {
  Face face;
  for (int i = 0; i < 4; ++i) face.x[i] = master.X.col(master.face(i, c.face));
  return normal(face, c.xi, c.eta);
}

// Of all contacts that lie within a master flank; their gaps are `offset` less than they are.
void add_errors(const std::vector<ContactPoint>& contacts, const Sides (&sides)[2], double offset,
                GapErrors& error) {
  for (const ContactPoint& c : contacts) {
    const Sides& s = sides[c.slave_side];
    const Vector3d x = s.node(c.slave_node);
    const test::Flank flank = s.masters.flank[c.face];
    if (!test::is_within(s.masters, s.master_at, flank, x, kMargin)) continue;
    const double gap = c.g_n - offset, exact = test::distance(s.masters, s.master_at, flank, x),
                 along = -gear::flank_distance_along(s.masters.toothing, flank, in_body(s.master_at, x),
                                                     face_normal(s.masters.surface, c));
    error.largest = std::max(error.largest, std::abs(gap - exact));
    error.along = std::max(error.along, std::abs(gap - along));
    ++error.nodes;
  }
}

// Both bodies as slaves, at two angles.
GapErrors gap_errors(const WormDrive& drive, ContactSurface surface) {
  Settings settings;
  settings.stiffness = 1;
  settings.two_pass = true;
  settings.surface = surface;
  settings.depth = kNear;
  settings.offset = -kNear;
  settings.extension = 0;
  Pair pair(drive.worm.surface, drive.wheel.surface, settings, {}, {&drive.worm.exact, &drive.wheel.exact});
  GapErrors error;
  for (double phi_1 : {0., 1.}) {
    const SurfaceMotion worm = test::worm_motion(drive, phi_1), wheel = test::wheel_motion(drive, phi_1, 0);
    const Sides sides[2] = {{drive.worm, drive.wheel, worm, wheel}, {drive.wheel, drive.worm, wheel, worm}};
    add_errors(pair.detect(worm, wheel), sides, settings.offset, error);
  }
  return error;
}

// A facet is off by its sagitta, which falls with the square of its length over the radius of curvature, and
// that grows from the root to the tip. Gaps to the exact surface are those along the normal of a face, which
// turns against the flank: 0.3 mm away the distance is 0.2 % less.
TEST(WormDrive, gap_of_the_search_is_the_exact_distance_up_to_facets) {
  constexpr double kRate = 0.34, kSmoothRate = 0.22, kSmoothest = 0.4;  // found: 0.32; 0.19, 0.14; 0.38
  constexpr double kLargest = 0.7e-6, kAlong = 0.05e-6;  // m, found of the first: 0.55, 0.41, 0.12
  GapErrors facets, smooth;
  for (int n : {1, 2, 4}) {
    const WormDrive drive = test::worm_drive(n);
    const GapErrors before[2] = {facets, smooth}, exact = gap_errors(drive, ContactSurface::exact);
    facets = gap_errors(drive, ContactSurface::facets);
    smooth = gap_errors(drive, ContactSurface::smooth);
    std::printf(
        "gap of the search, %d rows, um: facets %.3g, smooth %.3g, exact %.3g, along the normal %.3g\n",
        2 * n, 1e6 * facets.largest, 1e6 * smooth.largest, 1e6 * exact.largest, 1e6 * exact.along);
    EXPECT_GT(facets.nodes, 50);
    if (n == 1) {
      EXPECT_LT(facets.largest, 45e-6);
      EXPECT_LT(smooth.largest, kSmoothest * facets.largest);
    } else {
      EXPECT_LT(facets.largest, kRate * before[0].largest);
      EXPECT_LT(smooth.largest, kSmoothRate * before[1].largest);
    }
    EXPECT_LT(exact.largest, kLargest);
    elastogear::test::figure({"exact flanks", "gap along the face's normal", "µm"}, exact.along, kAlong);
  }
}

// Largest distance of the exact surface, as contact takes it, from the involute helicoid, m.
double surface_error(const Flanks& flanks) {
  constexpr int kSamples = 24;
  const model::Surface& s = flanks.surface;
  const Topology map = topology(s.face, static_cast<int>(s.X.cols()));
  const SurfaceView view{s.face, map, s.X, 0};
  const Heights heights = make_heights(view, ContactSurface::exact, kFeatureAngle, flanks.exact);
  double error = 0;
  for (int f = 0; f < s.face.cols(); ++f) {
    const Face face = face_of(view, f);
    for (int i = 0; i <= kSamples; ++i)
      for (int j = 0; j <= kSamples; ++j) {
        const double u = 2. * i / kSamples - 1, v = 2. * j / kSamples - 1;
        const Vector3d x =
            combine(face, shape(4, u, v).N) + height(heights, 4, f, u, v).f * normal(face, u, v);
        error = std::max(error, std::abs(gear::flank_distance(flanks.toothing, flanks.flank[f].tooth,
                                                              flanks.flank[f].side, x)));
      }
  }
  return error;
}

TEST(WormDrive, exact_surface_is_the_involute_helicoid) {
  constexpr double kCoarsest = 0.05e-6, kRate = 0.15;  // m, found: 0.021; 0.06 to 0.09
  double last[2] = {};
  for (int n : {1, 2, 4}) {
    const WormDrive drive = test::worm_drive(n);
    for (int body : {0, 1}) {
      const double error = surface_error(body == 0 ? drive.worm : drive.wheel);
      std::printf("exact surface of the %s, %d rows: %.2g um\n", body == 0 ? "worm" : "wheel", 2 * n,
                  1e6 * error);
      EXPECT_LT(error, n == 1 ? kCoarsest : kRate * last[body]);
      last[body] = error;
    }
  }
}

// ---- a full pitch

struct Census {
  int touching = 0, lost = 0, twice = 0, without_reason = 0;
};

// How deep a point is behind an exact flank, away from its ends, m; 0: it is not.
double depth(const Sides& sides, const Vector3d& x) {
  for (int tooth = 0; tooth < sides.masters.toothing.z; ++tooth)
    for (int side : {1, -1}) {
      const test::Flank flank{tooth, side};
      const double d = test::distance(sides.masters, sides.master_at, flank, x);
      if (d < 0 && d > -kNear && test::is_within(sides.masters, sides.master_at, flank, x, kMargin))
        return -d;
    }
  return 0;
}

// Contacts by slave node against the nodes that are deeper than `facets` explain.
void count(const std::map<int, const ContactPoint*>& found, const Sides& sides, double facets,
           Census& census) {
  for (int node = 0; node < sides.slaves.surface.X.cols(); ++node) {
    const Vector3d x = sides.node(node);
    const auto contact = found.find(node);
    if (contact != found.end()) {
      const test::Flank flank = sides.masters.flank[contact->second->face];
      census.without_reason += test::distance(sides.masters, sides.master_at, flank, x) > facets;
    } else if (depth(sides, x) > facets) {
      ++census.lost;
    }
  }
  census.touching += static_cast<int>(found.size());
}

// Both bodies as slaves, at many angles over a pitch.
Census census(const WormDrive& drive, double facets) {
  constexpr int kAngles = 24;
  Settings settings;
  settings.stiffness = 1;
  settings.two_pass = true;
  settings.surface = ContactSurface::facets;
  settings.depth = 0.3e-3;
  Pair pair(drive.worm.surface, drive.wheel.surface, settings);
  Census census;
  for (int i = 0; i < kAngles; ++i) {
    const double phi_1 = 2 * kPi / drive.design.z1 * i / kAngles;
    const SurfaceMotion worm = test::worm_motion(drive, phi_1),
                        wheel = test::wheel_motion(drive, phi_1, pressed(drive, 3 * facets));
    std::map<int, const ContactPoint*> found[2];
    const auto contacts = pair.detect(worm, wheel);
    for (const ContactPoint& c : contacts)
      census.twice += !found[c.slave_side].emplace(c.slave_node, &c).second;
    count(found[0], {drive.worm, drive.wheel, worm, wheel}, facets, census);
    count(found[1], {drive.wheel, drive.worm, wheel, worm}, facets, census);
  }
  return census;
}

TEST(WormDrive, loses_no_node_and_counts_none_twice_over_a_pitch) {
  constexpr double kSampled = 1.5;  // the facets' error is known at two angles only
  for (int n : {1, 2}) {
    const WormDrive drive = test::worm_drive(n);
    const Census c = census(drive, kSampled * gap_errors(drive, ContactSurface::facets).largest);
    EXPECT_GT(c.touching, 200);
    EXPECT_EQ(c.lost, 0);
    EXPECT_EQ(c.twice, 0);
    EXPECT_EQ(c.without_reason, 0);
  }
}

// ---- slow rolling under constant torque

struct Torques {
  double worm, wheel;  // N m, about their axes
};

Torques torques(Pair& pair, const WormDrive& drive, double phi_1, double ahead) {
  const SurfaceMotion at[2] = {test::worm_motion(drive, phi_1), test::wheel_motion(drive, phi_1, ahead)};
  const model::Surface* surface[2] = {&drive.worm.surface, &drive.wheel.surface};
  Vector3d force = Vector3d::Zero(), moment = Vector3d::Zero();  // on the wheel, about the origin
  for (const ContactPoint& c : pair.detect(at[0], at[1])) {
    const Vector3d x =
        at[c.slave_side].R_WB * surface[c.slave_side]->X.col(c.slave_node) + at[c.slave_side].r_WB;
    const Vector3d f = c.slave_side == 1 ? Vector3d(c.F.col(0)) : Vector3d(-c.F.col(0));
    force += f;
    moment += x.cross(f);
  }
  return {-(moment - at[0].r_WB.cross(force)).x(), moment.z()};
}

// The worm's torque where the wheel's is T, which grows with the wheel's lag: regula falsi (Illinois).
double torque_of_worm(Pair& pair, const WormDrive& drive, double phi_1, double T) {
  constexpr double kTolerance = 1e-7;
  const auto missing = [&](double lag) { return std::abs(torques(pair, drive, phi_1, lag).wheel) - T; };
  double a = pressed(drive, 0) * 0.5, b = pressed(drive, 150e-6), f_a = missing(a), f_b = missing(b), f = f_b;
  while (std::abs(f) > kTolerance * T) {
    const double c = (a * f_b - b * f_a) / (f_b - f_a);
    f = missing(c);
    if (f * f_b < 0)
      a = b, f_a = f_b;
    else
      f_a /= 2;
    b = c, f_b = f;
  }
  return torques(pair, drive, phi_1, b).worm;
}

struct Ripple {
  double mean, ripple;  // N m; (largest - smallest) / mean
};

Ripple ripple(const WormDrive& drive, ContactSurface surface) {
  constexpr int kAngles = 96;
  constexpr double kTorque = 20, kStiffness = 1e14;  // N m, Pa/m
  Settings settings;
  settings.stiffness = kStiffness;
  settings.two_pass = true;
  settings.surface = surface;
  settings.depth = 0.3e-3;
  Pair pair(drive.worm.surface, drive.wheel.surface, settings, {}, {&drive.worm.exact, &drive.wheel.exact});
  double sum = 0, smallest = 1e9, largest = 0;
  for (int i = 0; i < kAngles; ++i) {
    const double T = std::abs(torque_of_worm(pair, drive, 2 * kPi / drive.design.z1 * i / kAngles, kTorque));
    sum += T;
    smallest = std::min(smallest, T), largest = std::max(largest, T);
  }
  return {sum / kAngles, (largest - smallest) * kAngles / sum};
}

// The worm's torque of an ideal drive is the wheel's over the ratio at any angle; on average it is that of
// any contact without losses. Smooth and exact surfaces leave the ripple of a patch with few nodes.
TEST(WormDrive, ripple_of_the_torque_falls_with_the_square_of_the_face_size_and_with_the_surface) {
  const double order = 1.8, sampling[3] = {1e-2, 1e-3, 1e-3};
  constexpr double kAlike = 0.1, kSmoothing = 0.4;  // found: 0.04, 0.07, 0.02; 0.34
  const int finest = 4;
  double first[3] = {}, last[3] = {};
  for (int n : {1, 2, finest}) {
    const WormDrive drive = test::worm_drive(n);
    for (int i = 0; i < 3; ++i) {
      const Ripple r = ripple(drive, kSurfaces[i]);
      std::printf("%s, %d rows: ripple %.3g %%, mean off by %.2g %%\n", kNames[i], 2 * n, 100 * r.ripple,
                  100 * std::abs(r.mean * drive.geometry.ratio / 20 - 1));
      EXPECT_NEAR(r.mean, 20 / drive.geometry.ratio, sampling[i] * r.mean);
      last[i] = r.ripple;
      if (n == 1) first[i] = r.ripple;
    }
    EXPECT_NEAR(last[kSmooth], last[kExact], kAlike * last[kExact]);
  }
  EXPECT_LT(last[kSmooth], kSmoothing * last[kFacets]);
  for (int i : {kFacets, kSmooth}) EXPECT_LT(last[i], first[i] * std::pow(finest, -order));
}

}  // namespace
}  // namespace elastogear::contact::worm_drive_test
