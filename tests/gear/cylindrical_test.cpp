#include "elastogear/gear/cylindrical.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

#include "elastogear/base/error.h"
#include "mesh_checks.h"

namespace elastogear::gear::cylindrical_test {
namespace {

using std::numbers::pi;
constexpr double kDegree = pi / 180, kMm = 1e-3;

CylindricalGear gear(const std::string& name, int z, double x, double width) {
  CylindricalGear g;
  g.name = name, g.z = z, g.x = x;
  g.blank.face_width = width;
  return g;
}

CylindricalDrive drive(double m_n, double beta, CylindricalGear pinion, CylindricalGear wheel) {
  CylindricalDrive d;
  d.m_n = m_n, d.beta = beta;
  d.gears = {std::move(pinion), std::move(wheel)};
  d.pairs = {GearPair{}};
  return d;
}

// Test gears C14 of the FZG, whose tips are not shortened.
CylindricalDrive c14() {
  CylindricalDrive d = drive(4.5e-3, 0, gear("pinion", 16, 0.1817, 14e-3), gear("wheel", 24, 0.1715, 14e-3));
  d.gears[0].r_a = 82.635e-3 / 2, d.gears[1].r_a = 118.544e-3 / 2;
  d.pairs[0].a = 91.5e-3;
  return d;
}

CylindricalDrive helical() {
  return drive(3e-3, 25 * kDegree, gear("pinion", 19, 0.2, 24e-3), gear("wheel", 31, -0.1, 24e-3));
}

// Undercut by more than half of what a standard rack cuts.
CylindricalDrive undercut() {
  return drive(2e-3, 0, gear("pinion", 9, 0.1, 10e-3), gear("wheel", 40, 0, 10e-3));
}

TEST(CylindricalGeometry, of_the_test_gears_C14_is_the_published_one) {
  const CylindricalGeometry g = derive(c14());
  EXPECT_NEAR(g.pair[0].epsilon_alpha, 1.462, 5e-4);
  EXPECT_NEAR(200 / g.gear[0].r_b, 5912.1, 0.05);         // N, normal force under 200 N m
  EXPECT_NEAR(g.pair[0].j_n, kBacklash * 4.5e-3, 1e-12);  // the rounded shifts overlap by 0.06 um
}

// ISO 21771: s_an = s_at cos(beta_a), tan(beta_a) = tan(beta) d_a/d.
TEST(CylindricalGeometry, has_the_tip_thickness_at_the_helix_angle_of_the_tip) {
  CylindricalDrive d = helical();
  d.beta = 30 * kDegree;
  const CylindricalGeometry g = derive(d);
  const Toothing& t = g.gear[0];
  const double beta_a = std::atan(std::tan(d.beta) * t.r_a / t.r);
  EXPECT_NEAR(normal_thickness(t, t.r_a), 2 * t.r_a * psi(t, t.r_a) * std::cos(beta_a), 1e-12);
  EXPECT_NEAR(normal_thickness(derive(c14()).gear[0], 41e-3), 2 * 41e-3 * psi(derive(c14()).gear[0], 41e-3),
              1e-12);
}

// ISO 21771: inv alpha_wt = inv alpha_t + 2 (x_1 + x_2) tan alpha_n / (z_1 + z_2).
TEST(CylindricalGeometry, has_the_centre_distance_of_its_profile_shifts_and_the_backlash_of_thinner_teeth) {
  CylindricalDrive d = helical();
  d.j_n = 0.08e-3;
  const CylindricalGeometry g = derive(d);
  const double alpha_t = std::atan(std::tan(20 * kDegree) / std::cos(d.beta));
  EXPECT_NEAR(involute(g.pair[0].alpha_wt), involute(alpha_t) + 2 * 0.1 * std::tan(20 * kDegree) / 50, 1e-12);
  EXPECT_NEAR(g.pair[0].a,
              3e-3 * 50 / (2 * std::cos(d.beta)) * std::cos(alpha_t) / std::cos(g.pair[0].alpha_wt), 1e-12);
  EXPECT_NEAR(g.pair[0].j_n, 0.08e-3, 1e-12);
  for (const Toothing& t : g.gear)
    EXPECT_NEAR(2 * pi / t.z * t.r_b * std::cos(t.beta_b), g.p_bn, 1e-12 * g.p_bn);
  EXPECT_NEAR(g.gear[0].p / g.gear[1].p, -19.0 / 31, 1e-12);  // hands alternate
}

TEST(CylindricalGeometry, keeps_the_clearance_of_tips_that_are_not_given) {
  CylindricalDrive d = drive(3e-3, 0, gear("pinion", 20, 0.8, 20e-3), gear("wheel", 25, 0.7, 20e-3));
  const CylindricalGeometry g = derive(d);
  for (double c : g.pair[0].c) EXPECT_NEAR(c, kLeastClearance * 3e-3, 1e-12);
}

Eigen::Vector3d to_body(const CylindricalGeometry& g, int i, double angle, const Eigen::Vector3d& x) {
  return Eigen::AngleAxisd(-angle, Eigen::Vector3d::UnitZ()) *
         (x - Eigen::Vector3d(g.axis[i][0], g.axis[i][1], 0));
}

double least_distance(const Toothing& t, int side, const Eigen::Vector3d& x) {
  double least = 1;
  for (int tooth = 0; tooth < t.z; ++tooth)
    if (const double d = flank_distance(t, tooth, side, x); std::abs(d) < std::abs(least)) least = d;
  return least;
}

// At any roll angle the point of each line of action where the first gear's flank is lies on the second
// one's.
void expect_touching_flanks(const CylindricalDrive& d, bool drive_side) {
  const CylindricalGeometry g = derive(d);
  const int side = drive_side ? 1 : -1;
  const PairGeometry& p = g.pair[0];
  for (double roll : {0.0, 0.13, 0.5, 0.77, 3.2}) {
    const auto angle = angles(d, g, roll, drive_side);
    for (double z : {-0.4 * d.gears[0].blank.face_width, 0.0, 2e-3}) {
      // A normal through a point of the line of action meets its flanks there; its distances add up to
      // nothing.
      const double action = p.a * std::sin(p.alpha_wt);
      const Eigen::Vector3d x(
          g.gear[0].r_b * std::cos(p.alpha_wt) + action / 2 * std::sin(p.alpha_wt),
          side * (-g.gear[0].r_b * std::sin(p.alpha_wt) + action / 2 * std::cos(p.alpha_wt)), z);
      const double d_1 = least_distance(g.gear[0], side, to_body(g, 0, angle[0], x));
      const double d_2 = least_distance(g.gear[1], side, to_body(g, 1, angle[1], x));
      EXPECT_NEAR(std::remainder(d_1 + d_2, g.p_bn), 0, 1e-12) << "roll " << roll << ", z " << z;
    }
  }
}

TEST(Angles, bring_the_flanks_that_carry_into_touch) {
  for (bool drive_side : {true, false}) {
    expect_touching_flanks(c14(), drive_side);
    expect_touching_flanks(helical(), drive_side);
    expect_touching_flanks(undercut(), drive_side);
  }
}

TEST(Angles, turn_a_train_in_the_ratio_of_its_teeth) {
  CylindricalDrive d = drive(2e-3, 15 * kDegree, gear("a", 17, 0, 10e-3), gear("b", 30, 0, 10e-3));
  d.gears.push_back(gear("c", 44, 0, 10e-3));
  d.pairs.push_back({.first = 1, .second = 2, .direction = 70 * kDegree});
  const CylindricalGeometry g = derive(d);
  const auto at = angles(d, g, 0.2), later = angles(d, g, 1.2);
  EXPECT_NEAR(later[0] - at[0], 2 * pi / 17, 1e-12);
  EXPECT_NEAR(later[1] - at[1], -2 * pi / 30, 1e-12);
  EXPECT_NEAR(later[2] - at[2], 2 * pi / 44, 1e-12);
  EXPECT_NEAR((g.axis[2] - g.axis[1]).norm(), g.pair[1].a, 1e-12);
}

// How far the rack stays away from a point of the gear's transverse section while it rolls by, along its
// pitch line, m; > 0 outside the tool. The tool's section: straight flanks, a rounded tip of rho, dedendum
// depth.
double rolled_clearance(const CylindricalDrive& d, const CylindricalGeometry& g, int i, double angle,
                        double radius) {
  constexpr int kPositions = 40000;
  const Toothing& t = g.gear[i];
  const double alpha = d.rack.alpha_n, cos_beta = d.m_n * t.z / (2 * t.r), depth = t.r - t.r_f;
  const double rho = d.rack.rho_fP * d.m_n, half_pitch = pi * d.m_n / 2, centre = rho - depth;
  // Half the tool's thickness at the height h over the pitch line; its flank is g.s_n/2 from the tooth's
  // middle at h = 0. A protuberance is a flank of its own that touches the arc.
  const double pr = d.rack.pr * d.m_n, alpha_pr = pr > 0 ? d.rack.alpha_pr : alpha;
  const double straight_end = centre - rho * std::sin(alpha_pr);
  const double arc = half_pitch - g.s_n[i] / 2 - (rho - pr - centre * std::sin(alpha)) / std::cos(alpha);
  const auto half_tool = [&](double h) {
    const double flank = half_pitch - g.s_n[i] / 2 + h * std::tan(alpha);
    if (h >= straight_end)
      return std::max(flank, arc + rho * std::cos(alpha_pr) + (h - straight_end) * std::tan(alpha_pr));
    const double tip = arc + std::sqrt(std::max(0.0, rho * rho - (h - centre) * (h - centre)));
    return h > centre - rho * std::sin(alpha) ? std::max(flank, tip) : tip;
  };
  double least = 1;
  for (int k = -kPositions; k <= kPositions; ++k) {
    const double turned =
        1.5 * 2 * pi / t.z * k / kPositions;  // of the gear; the rack moves with its pitch circle
    const double x = radius * std::sin(angle + turned), h = radius * std::cos(angle + turned) - t.r;
    if (h < -depth) continue;
    const double u = (x - t.r * turned) * cos_beta;  // from the middle of the tooth, normal section
    least = std::min(least, std::abs(u - half_pitch) - half_tool(h));
  }
  return least;
}

void expect_swept_fillet(const CylindricalDrive& d, int i) {
  constexpr double kExact = 1e-7;  // m, the least that is asked for
  const CylindricalGeometry g = derive(d);
  const Toothing& t = g.gear[i];
  const mesh::Mesh mesh = cylindrical_mesh(d, g, i, cylindrical_counts(d, g, i, Size::small));
  int checked = 0;
  for (int node : mesh.node_sets.at("root_" + std::string(t.z > 9 ? "01" : "1"))) {
    const Eigen::Vector3d x = mesh.X.col(node);
    // Positive angles are on the tooth's side of larger u, clockwise from the tooth's axis.
    const double angle = std::remainder(pi / 2 + x[2] / t.p - std::atan2(x[1], x[0]), 2 * pi);
    if (x[2] > 0 || angle < 0) continue;
    const double least = rolled_clearance(d, g, i, angle, x.head<2>().norm());
    if (x.head<2>().norm() > t.r_f + 1e-9) {
      EXPECT_NEAR(least, 0, kExact) << "radius " << x.head<2>().norm() << ", form " << t.r_form;
    }
    ++checked;
  }
  EXPECT_GT(checked, 5);
}

TEST(Fillet, is_what_the_rack_leaves_that_rolls_by) {
  expect_swept_fillet(c14(), 0);
  expect_swept_fillet(helical(), 1);
  expect_swept_fillet(undercut(), 0);
  EXPECT_TRUE(derive(undercut()).gear[0].undercut);
  EXPECT_FALSE(derive(undercut()).gear[1].undercut);
}

// Teeth that are cut for grinding; the root of the wheel is inside its base circle or outside.
CylindricalDrive for_grinding(double pr, double alpha_pr, double beta, int z_2 = 80) {
  CylindricalDrive d = drive(4e-3, beta, gear("pinion", 19, 0.35, 30e-3), gear("wheel", z_2, 0.1, 30e-3));
  d.rack.h_fP = 1.4, d.rack.pr = pr, d.rack.alpha_pr = alpha_pr;
  return d;
}

TEST(Fillet, is_what_a_tool_with_protuberance_leaves) {
  for (const auto& [pr, z_2, i] : {std::tuple(0.005, 80, 0), {0.03, 43, 0}, {0.06, 43, 1}, {0.03, 80, 1}}) {
    const CylindricalDrive d = for_grinding(pr, 10 * kDegree, i == 0 ? 0 : 15 * kDegree, z_2);
    expect_swept_fillet(d, i);
    CylindricalDrive without = d;
    without.rack.pr = 0, without.rack.alpha_pr = -1;
    EXPECT_GT(derive(d).gear[i].r_form, derive(without).gear[i].r_form);
  }
}

void expect_good_mesh(const CylindricalDrive& d, int i) {
  const CylindricalGeometry g = derive(d);
  const Toothing& t = g.gear[i];
  const mesh::Mesh mesh = cylindrical_mesh(d, g, i, cylindrical_counts(d, g, i, Size::tiny));
  expect_good_cells(mesh);
  expect_conforming(mesh);
  expect_distinct_used_nodes(mesh);
  const std::string tooth = t.z > 9 ? "tooth_02" : "tooth_2";
  expect_flank(mesh, tooth + "_left", t, 1, +1);
  expect_flank(mesh, tooth + "_right", t, 1, -1);
}

TEST(CylindricalMesh, has_good_cells_and_exact_flanks) {
  expect_good_mesh(c14(), 0);
  expect_good_mesh(helical(), 0);
  expect_good_mesh(helical(), 1);
  expect_good_mesh(undercut(), 0);
  expect_good_mesh(for_grinding(0.04, 10 * kDegree, 0), 0);
  CylindricalDrive webbed = helical();
  Blank& b = webbed.gears[1].blank;
  b.bore = 20e-3, b.hub_diameter = 34e-3, b.hub_width = 28e-3, b.web_diameter = 74e-3, b.web_width = 8e-3;
  expect_good_mesh(webbed, 1);
}

// Any pair of external gears.
CylindricalDrive random_drive(std::mt19937& random) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<>(low, high)(random);
  };
  const double m_n = between(0.5e-3, 10e-3), beta = between(0, 1) < 0.4 ? 0 : between(0, 35 * kDegree);
  const int z_1 = 6 + static_cast<int>(60 * std::pow(between(0, 1), 2)),
            z_2 = std::max(z_1, static_cast<int>(between(6, 121)));
  const double width = between(4, 15) * m_n;
  return drive(m_n, beta, gear("pinion", z_1, between(-0.5, 0.8), width),
               gear("wheel", z_2, between(-0.5, 0.8), width));
}

bool has_tips_of(double modules, const CylindricalDrive& d, const CylindricalGeometry& g) {
  for (const Toothing& t : g.gear)
    if (2 * t.r_a * psi(t, t.r_a) * d.m_n * t.z / (2 * t.r) < modules * d.m_n) return false;
  return true;
}

// The bounds are those of the designs that count as possible.
TEST(CylindricalMesh, of_200_random_designs_has_good_cells) {
  std::mt19937 random(1);
  int possible = 0, undercut = 0;
  while (possible < 200) {
    const CylindricalDrive d = random_drive(random);
    CylindricalGeometry g;
    try {
      g = derive(d);
    } catch (const Error&) {
      continue;
    }
    if (g.pair[0].epsilon_alpha < 1.1 || !has_tips_of(0.2, d, g)) continue;
    ++possible;
    undercut += g.gear[0].undercut;
    for (int i : {0, 1}) {
      SCOPED_TRACE(std::to_string(g.gear[i].z) + " teeth, x = " + std::to_string(d.gears[i].x));
      expect_good_cells(cylindrical_mesh(d, g, i, cylindrical_counts(d, g, i, Size::tiny)));
    }
  }
  EXPECT_GT(undercut, 10);
}

struct Refusal {
  const char* message;  // that must occur
  std::function<void(CylindricalDrive&)> change;
  std::function<void(CylindricalDrive&)> remedy;  // what the message says would do
};
void PrintTo(const Refusal& refusal, std::ostream* os) { *os << refusal.message; }

class CylindricalRefusal : public testing::TestWithParam<Refusal> {};

TEST_P(CylindricalRefusal, names_the_value_and_one_that_would_do) {
  CylindricalDrive d = drive(3e-3, 0, gear("pinion", 17, 0.3, 25e-3), gear("wheel", 43, 0.1, 25e-3));
  GetParam().change(d);
  try {
    derive(d);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(GetParam().message), std::string::npos) << error.what();
  }
  if (!GetParam().remedy) return;
  GetParam().remedy(d);
  EXPECT_NO_THROW(derive(d));
}

TEST(CylindricalRefusal, names_the_nearest_profile_shift_with_which_contact_does_not_end) {
  CylindricalDrive d = drive(3e-3, 0, gear("pinion", 7, -0.1, 25e-3), gear("wheel", 115, 0.6, 25e-3));
  std::string message;
  try {
    derive(d);
  } catch (const Error& error) {
    message = error.what();
  }
  const std::string remedy = "profile_shift of pinion of at least ";
  const std::size_t at = message.find(remedy);
  ASSERT_NE(at, std::string::npos) << message;
  d.gears[0].x = std::stod(message.substr(at + remedy.size()));
  EXPECT_NO_THROW(derive(d));
  d.gears[0].x -= 0.01;
  EXPECT_THROW(derive(d), Error);
}

INSTANTIATE_TEST_SUITE_P(
    All, CylindricalRefusal,
    testing::Values(
        Refusal{"module: 3 mm", [](auto& d) { d.m_n = 3; }, {}},
        Refusal{"module = nan", [](auto& d) { d.m_n = std::nan(""); }, {}},
        Refusal{"pinion: teeth = 3", [](auto& d) { d.gears[0].z = 3; }, {}},
        Refusal{"wheel: profile_shift = inf",
                [](auto& d) { d.gears[1].x = std::numeric_limits<double>::infinity(); },
                {}},
        Refusal{"helix_angle = 60", [](auto& d) { d.beta = 60 * kDegree; }, {}},
        Refusal{"face_width = 0", [](auto& d) { d.gears[1].blank.face_width = 0; }, {}},
        Refusal{"at least 91.147", [](auto& d) { d.pairs[0].a = 91e-3; },
                [](auto& d) { d.pairs[0].a = 91.148e-3; }},
        Refusal{"backlash = 0.01 mm: the centre distance leaves",
                [](auto& d) { d.pairs[0].a = 91.5e-3, d.j_n = 0.01e-3; }, [](auto& d) { d.j_n = 0.3e-3; }},
        Refusal{"pointed", [](auto& d) { d.gears[0].r_a = 34e-3; }, [](auto& d) { d.gears[0].r_a = 0; }},
        Refusal{"reaches the root of pinion; tip_diameter below 136.9",
                [](auto& d) { d.gears[1].r_a = 68.5e-3; },
                {}},
        Refusal{"cuts into the root of pinion; tip_diameter of at most 136.35",
                [](auto& d) { d.gears[1].r_a = 68.4e-3; }, [](auto& d) { d.gears[1].r_a = 136.35e-3 / 2; }},
        Refusal{"contact ratio", [](auto& d) { d.gears[0].r_a = 28e-3, d.gears[1].r_a = 65.5e-3; }, {}},
        Refusal{"profile_shift 0.59 of pinion and 0.05 of wheel would do",
                [](auto& d) {
                  d.gears = {gear("pinion", 11, 0.4397, 25e-3), gear("wheel", 42, -0.1028, 25e-3)};
                  d.rack.h_fP = 1.4, d.rack.pr = 0.0914;
                },
                [](auto& d) { d.gears[0].x = 0.59, d.gears[1].x = 0.05; }},
        Refusal{"profile_shift 0.37 of pinion and 0.87 of wheel would do",
                [](auto& d) {
                  d.gears = {gear("pinion", 6, -0.06, 25e-3), gear("wheel", 116, -0.33, 25e-3)};
                },
                [](auto& d) { d.gears[0].x = 0.37, d.gears[1].x = 0.87; }},
        Refusal{"rack_protuberance = 0.0916: its fillet leaves no flank; at most 0.076 would do",
                [](auto& d) {
                  d.gears = {gear("pinion", 22, 0.4471, 25e-3), gear("wheel", 29, 0.4832, 25e-3)};
                  d.rack.h_fP = 1.4, d.rack.pr = 0.0916;
                },
                [](auto& d) { d.rack.pr = 0.076; }},
        Refusal{"rack_fillet = 0.6 does not fit, at most 0.47", [](auto& d) { d.rack.rho_fP = 0.6; },
                [](auto& d) { d.rack.rho_fP = 0.47; }},
        Refusal{"pinion: bore = 50 mm: must be positive and at most",
                [](auto& d) { d.gears[0].blank.bore = 50e-3; },
                {}},
        Refusal{"wheel: web_width = 30",
                [](auto& d) {
                  Blank& b = d.gears[1].blank;
                  b.hub_diameter = 70e-3, b.web_diameter = 90e-3, b.web_width = 30e-3;
                },
                [](auto& d) { d.gears[1].blank.web_width = 8e-3; }},
        Refusal{
            "gear idler is in no pair", [](auto& d) { d.gears.push_back(gear("idler", 20, 0, 1e-2)); }, {}}));

}  // namespace
}  // namespace elastogear::gear::cylindrical_test
