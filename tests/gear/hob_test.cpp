// Wheels as their hobs leave them: against hobs swept numerically, and against the worm.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "elastogear/base/error.h"
#include "elastogear/gear/flank.h"
#include "mesh_checks.h"
#include "worm_designs.h"

namespace elastogear::gear::hob_test {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

Vector3d turned(const Vector3d& x, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * x[0] - s * x[1], s * x[0] + c * x[1], x[2]};
}
Vector3d worm_of_world(const Vector3d& x, double a) { return {x[1] - a, x[2], x[0]}; }

Vector3d flank_point(const Toothing& t, int side, double r, double z) {
  const double theta = tooth_angle(t, 0) + z / t.p + side * psi(t, r, side * z);
  return {r * std::cos(theta), r * std::sin(theta), z};
}

using Distance = std::function<double(const Vector3d& x)>;

// Distance (m) of a point of the worm to the thread's flank that runs with the wheel's flank on `side`, of
// the nearest thread.
Distance flank_of_worm(const Design& d, const Geometry& g, int side) {
  const int worm_side = d.hand == Hand::left ? side : -side;
  return [=, worm = g.worm](const Vector3d& x) {
    double nearest = 1;
    for (int thread = 0; thread < worm.z; ++thread) {
      const double at = flank_distance(worm, thread, worm_side, x);
      if (std::abs(at) < std::abs(nearest)) nearest = at;
    }
    return nearest;
  };
}

// m, of a point of tooth 1 of the wheel while the drive turns.
double least_distance(const Distance& distance_to, const Design& d, const Geometry& g, const Vector3d& x) {
  const double sense = d.hand == Hand::left ? -1 : 1;
  const auto distance = [&](double phi_1) {
    return distance_to(turned(worm_of_world(turned(x, sense * phi_1 / g.ratio), d.a), -phi_1));
  };
  constexpr int kSteps = 1000;
  double least = 1, at = 0;
  const double range = 2 * pi * 1.6 / d.z1, step = range / kSteps;
  for (int i = -kSteps; i <= kSteps; ++i)
    if (const double now = distance(i * step); std::abs(now) < 0.4e-3 && now < least)
      least = now, at = i * step;
  for (int i = -100; i <= 100; ++i) least = std::min(least, distance(at + i * step / 100));
  return least;
}

struct Drive {
  FlankForm form;
  int starts;
  WheelForm wheel = WheelForm::throated;
  Hand hand = Hand::right;
  double x2 = 0;  // at the same centre distance
};
void PrintTo(const Drive& d, std::ostream* os) {
  *os << "form " << static_cast<int>(d.form) << " starts " << d.starts;
}

Design design(const Drive& drive) {
  Design d = worm_design(drive.form, drive.starts, drive.wheel);
  d.hand = drive.hand, d.x2 = drive.x2;
  return d;
}

class HobbedWheel : public testing::TestWithParam<Drive> {};
INSTANTIATE_TEST_SUITE_P(All, HobbedWheel,
                         testing::Values(Drive{FlankForm::ZI, 1}, Drive{FlankForm::ZA, 2},
                                         Drive{FlankForm::ZN, 3}, Drive{FlankForm::ZK, 4},
                                         Drive{FlankForm::ZK, 1, WheelForm::throated, Hand::left},
                                         Drive{FlankForm::ZI, 5, WheelForm::cylindrical},
                                         Drive{FlankForm::ZA, 6},
                                         Drive{FlankForm::ZI, 2, WheelForm::throated, Hand::right, 0.397},
                                         Drive{FlankForm::ZK, 2, WheelForm::throated, Hand::right, -0.3},
                                         Drive{FlankForm::ZA, 1, WheelForm::cylindrical, Hand::left, 0.2},
                                         Drive{FlankForm::ZN, 2, WheelForm::cylindrical, Hand::left}));

// A worm without backlash is the hob.
TEST_P(HobbedWheel, flank_is_touched_and_never_entered_by_the_turning_thread) {
  Design d = design(GetParam());
  d.j_n = 0;
  const Geometry g = derive(d);
  const mesh::Mesh mesh = wheel_mesh(d, {});
  for (int side : {-1, 1})
    for (const mesh::Face& face : mesh::face_set(mesh, side > 0 ? "tooth_01_left" : "tooth_01_right"))
      for (int node : face) {
        const Vector3d x = mesh.X.col(node);
        EXPECT_NEAR(least_distance(flank_of_worm(d, g, side), d, g, x), 0, 1e-7)
            << "side " << side << ", " << x;
      }
}

// The hob of that worm has a round tip, which leaves the fillet. Axial distance to flank, arc and tip, > 0
// outside.
Distance hob_of_worm(const Design& d, const Geometry& g, int side) {
  const Distance flank = flank_of_worm(d, g, side);
  const double p = std::abs(g.worm.p), rho = d.wheel_rack_tip, r_c = g.worm.r - g.shift + d.dedendum - rho;
  const auto normal = [=](double r) {
    return Eigen::Vector2d(1, -p * half_angle(g.worm, r).d_r).normalized();
  };
  double low = g.worm.r - g.shift, high = r_c + rho;
  for (int i = 0; i < 60; ++i) {
    const double r = (low + high) / 2;
    (r - rho * normal(r)[1] < r_c ? low : high) = r;
  }
  const double c = p * psi(g.worm, low) - rho * normal(low)[0],
               begin = std::atan2(normal(low)[1], normal(low)[0]);
  return [=](const Vector3d& x) {
    const double r = x.head<2>().norm();
    double axial = 1;  // from the middle of the thread whose flank is nearest
    for (int thread = 0; thread < g.worm.z; ++thread) {
      const double turned = std::atan2(x[1], x[0]) - x[2] / g.worm.p - tooth_angle(g.worm, thread);
      const double at = -side * std::remainder(turned, 2 * pi) * g.worm.p;
      if (std::abs(at - c) < std::abs(axial - c)) axial = at;
    }
    const double angle = std::atan2(r - r_c, axial - c);
    if (angle < begin && angle > begin - pi) return (axial - p * psi(g.worm, r)) * std::cos(begin);
    return angle <= pi / 2 && angle > 0 ? std::hypot(axial - c, r - r_c) - rho : r - r_c - rho;
  };
}

TEST_P(HobbedWheel, fillet_is_touched_and_never_entered_by_the_round_tip_of_the_hob) {
  Design d = design(GetParam());
  d.j_n = 0;
  const Geometry g = derive(d);
  const mesh::Mesh mesh = wheel_mesh(d, wheel_counts(Size::small));
  for (int node : mesh::node_set(mesh, "root_01")) {
    const Vector3d x = mesh.X.col(node);
    const int side = std::remainder(std::atan2(x[1], x[0]) - x[2] / g.wheel.p - pi / 2, 2 * pi) > 0 ? 1 : -1;
    EXPECT_NEAR(least_distance(hob_of_worm(d, g, side), d, g, x), 0, 1e-7) << x.transpose();
  }
}

TEST_P(HobbedWheel, is_meshed_on_its_exact_flanks_with_good_cells) {
  const Design d = design(GetParam());
  const Geometry g = derive(d);
  for (Size size : {Size::tiny, Size::small}) {
    const mesh::Mesh mesh = wheel_mesh(d, wheel_counts(size));
    expect_conforming(mesh);
    expect_good_cells(mesh);
    for (int tooth : {0, 23})
      for (int side : {-1, 1}) {
        const std::string set =
            "tooth_" + std::string(tooth == 0 ? "01" : "24") + (side > 0 ? "_left" : "_right");
        EXPECT_LT(largest_distance(mesh, set, g.wheel, tooth, side), 1e-9);
      }
  }
}

// At the ends of this face the radius at which the mesh begins the flank is that of the fillet's end but for
// roundoff, which put nodes 0.4 mm off both.
TEST(HobbedWheel, is_meshed_on_its_flank_where_that_meets_the_fillet) {
  constexpr double kModule = 1.9e-3, kQuotient = 8.2;
  const double a = kModule / std::cos(std::atan(1 / kQuotient)) * (kQuotient + 40) / 2;
  Design d = proportioned(kModule, pi / 9, 1, 40, a);
  d.flank = FlankForm::ZN, d.wheel_form = WheelForm::throated;
  d.face_width = 7.75 * kModule;
  const Geometry g = derive(d);
  const mesh::Mesh mesh = wheel_mesh(d, wheel_counts(Size::tiny));
  for (int side : {-1, 1})
    EXPECT_LT(largest_distance(mesh, side > 0 ? "tooth_01_left" : "tooth_01_right", g.wheel, 0, side), 1e-9);
}

// The gap between the worm's flank and the wheel's teeth, turned until they touch, is 0 at any angle in line
// contact.
TEST_P(HobbedWheel, turns_with_the_worm_without_transmission_error) {
  const Design d = design(GetParam());
  const Geometry g = derive(d);
  const double sense = d.hand == Hand::left ? -1 : 1;
  const double closing = d.j_n / 2 / (g.wheel.r * std::cos(g.alpha_w) * std::cos(g.gamma_w));
  for (double phi_1 : {0.0, 0.5, 1.1, 2.0, 3.7}) {
    const int first = static_cast<int>(std::lround(-sense * phi_1 / g.ratio * d.z2 / (2 * pi)));
    for (int side : {-1, 1}) {
      double least = 1;
      for (int tooth = first - 2; tooth <= first + 2; ++tooth)
        for (int i = -12; i <= 12; ++i)
          for (int k = 0; k <= 60; ++k) {
            const double z = d.face_width / 2 * i / 12, r = std::lerp(g.wheel.r_form, g.wheel.r_a, k / 60.0);
            const double phi_2 = 2 * pi * tooth / d.z2 + sense * phi_1 / g.ratio + side * closing;
            const Vector3d x = turned(flank_point(g.wheel, side, r, z), phi_2);
            const Vector3d worm = turned(worm_of_world(x, d.a), -phi_1);
            if (worm.head<2>().norm() > g.worm.r_a || worm.head<2>().norm() < g.worm.r_form) continue;
            for (int thread = 0; thread < d.z1; ++thread) {
              const double at = flank_distance(g.worm, thread, static_cast<int>(-side * sense), worm);
              if (at < -0.4e-3) continue;  // another tooth's space
              least = std::min(least, at);
            }
          }
      EXPECT_NEAR(least, 0, 2e-7) << phi_1;
    }
  }
}

TEST(HobbedWheel, has_normals_that_are_gradients_of_the_distance) {
  for (double oversize : {0.0, 3e-3})
    for (Hand hand : {Hand::right, Hand::left}) {
      Design d = worm_design(FlankForm::ZK, 3);
      d.hand = hand, d.hob_oversize = oversize;
      const Geometry g = derive(d);
      const double h = 1e-7;
      for (int side : {-1, 1})
        for (double z : {-5e-3, 1e-3, 6e-3}) {
          const Vector3d x = flank_point(g.wheel, side, g.wheel.r, z),
                         n = flank_normal(g.wheel, {0, side}, x);
          for (int i = 0; i < 3; ++i)
            EXPECT_NEAR(n[i],
                        (flank_distance(g.wheel, 0, side, x + h * Vector3d::Unit(i)) -
                         flank_distance(g.wheel, 0, side, x - h * Vector3d::Unit(i))) /
                            (2 * h),
                        1e-6);
        }
    }
}

TEST(HobbedWheel, is_made_for_worms_of_1_to_6_starts_of_all_forms) {
  for (FlankForm form : {FlankForm::ZA, FlankForm::ZN, FlankForm::ZI, FlankForm::ZK})
    for (int starts = 1; starts <= 6; ++starts)
      expect_good_cells(wheel_mesh(worm_design(form, starts), wheel_counts(Size::tiny)));
}

// A larger hob has the pitch point, and no other, in common with the worm: it takes more from the rest of the
// flank.
TEST(HobbedWheel, of_a_larger_hob_keeps_off_the_worm_but_in_the_middle) {
  Design d = worm_design(FlankForm::ZN, 2), same = d;
  d.hob_oversize = 2e-3;
  const Geometry g = derive(d), g_0 = derive(same);
  EXPECT_NEAR(psi(g.wheel, g.wheel.r) * g.wheel.r, psi(g_0.wheel, g.wheel.r) * g.wheel.r, 1e-6);
  EXPECT_GT(g.hob_swivel, 0);
  for (double z : {-6e-3, 6e-3})
    EXPECT_LT((psi(g.wheel, g.wheel.r + 0.5e-3, z) - psi(g_0.wheel, g.wheel.r + 0.5e-3, z)) * g.wheel.r,
              -1e-6);
}

std::string refusal(const std::function<void(Design&)>& change) {
  Design d = worm_design(FlankForm::ZK, 2);
  change(d);
  try {
    derive(d);
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(HobbedWheel, is_refused_where_it_cannot_be) {
  const double nan = std::nan("");
  const std::pair<const char*, std::function<void(Design&)>> cases[] = {
      {"choose cylindrical or throated", [](Design& d) { d.wheel_form = WheelForm::helical; }},
      {"cutter_diameter = nan", [=](Design& d) { d.cutter_diameter = nan; }},
      {"cutter_diameter = 0.001", [](Design& d) { d.cutter_diameter = 1e-3; }},
      {"only form ZK", [](Design& d) { d.flank = FlankForm::ZN, d.cutter_diameter = 50e-3; }},
      {"outside_diameter = nan", [=](Design& d) { d.outside_diameter = nan; }},
      {"at least the throat's", [](Design& d) { d.outside_diameter = 80e-3; }},
      {"only a throated wheel",
       [](Design& d) { d.wheel_form = WheelForm::cylindrical, d.outside_diameter = 90e-3; }},
      {"hob_oversize = nan", [=](Design& d) { d.hob_oversize = nan; }},
      {"smaller than the worm", [](Design& d) { d.hob_oversize = -1e-3; }},
      {"would do", [](Design& d) { d.face_width = 40e-3; }},
      {"wheel_rack_tip = 0.0011 m", [](Design& d) { d.wheel_rack_tip = 1.1e-3; }}};
  for (const auto& [message, change] : cases)
    EXPECT_NE(refusal(change).find(message), std::string::npos) << message << ": " << refusal(change);
}

}  // namespace
}  // namespace elastogear::gear::hob_test
