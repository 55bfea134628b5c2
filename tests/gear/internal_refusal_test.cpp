// Planets between sun and ring, and internal pairs that do not exist.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "elastogear/base/error.h"
#include "internal_drives.h"

namespace elastogear::gear::internal_refusal_test {
namespace {

using std::numbers::pi;

// Sun, planets at equal angles, and a ring that is held beside them.
CylindricalDrive planets(int z_sun, int z_planet, int z_ring, int n) {
  CylindricalDrive d;
  d.m_n = 2 * kMillimetre, d.beta = 10 * kRadPerDegree;
  d.gears = {external_gear("sun", z_sun, 0, 12 * kMillimetre)};
  for (int i = 0; i < n; ++i) {
    d.gears.push_back(external_gear("planet_" + std::to_string(i + 1), z_planet, 0, 12 * kMillimetre));
    d.pairs.push_back({.first = 0, .second = i + 1, .direction = 2 * pi * i / n});
  }
  d.gears.push_back(internal_gear("ring", z_ring, 0, 12 * kMillimetre));
  for (int i = 0; i < n; ++i) d.pairs.push_back({.first = i + 1, .second = n + 1, .coaxial = 0});
  return d;
}

TEST(Planets, mesh_with_sun_and_ring_at_equal_angles) {
  for (int n : {1, 3, 4}) {
    const CylindricalDrive d = planets(24, 24, 72, n);
    const CylindricalGeometry g = derive(d);
    EXPECT_LT(g.axis[n + 1].norm(), 1e-15);
    const auto at = angles(d, g, 0), later = angles(d, g, 24);
    EXPECT_NEAR(later[n + 1] - at[n + 1], -2 * pi * 24 / 72, 1e-12);
    for (int i = 0; i < n; ++i) {  // every planet between sun and ring as the first one is
      const auto phase = [&](int planet) {
        return std::remainder(at[planet] - d.pairs[planet - 1].direction * (1 + 24.0 / 24), 2 * pi / 24);
      };
      EXPECT_NEAR(std::remainder(phase(i + 1) - phase(1), 2 * pi / 24), 0, 1e-12);
    }
  }
}

struct Refusal {
  const char* message;  // that must occur
  std::function<void(CylindricalDrive&)> change;
  std::function<void(CylindricalDrive&)> remedy;  // what the message says would do
};
void PrintTo(const Refusal& refusal, std::ostream* os) { *os << refusal.message; }

class InternalRefusal : public testing::TestWithParam<Refusal> {};

void expect_refused(const CylindricalDrive& d, const std::string& message) {
  try {
    derive(d);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
  }
}

TEST_P(InternalRefusal, names_the_value_and_one_that_would_do) {
  CylindricalDrive d = spur_ring();
  GetParam().change(d);
  expect_refused(d, GetParam().message);
  if (!GetParam().remedy) return;
  GetParam().remedy(d);
  EXPECT_NO_THROW(derive(d));
}

INSTANTIATE_TEST_SUITE_P(
    All, InternalRefusal,
    testing::Values(
        Refusal{"both gears are internal", [](auto& d) { d.gears[0].internal = true; }, {}},
        Refusal{"has no room for 21", [](auto& d) { d.gears[1].z = 20; }, {}},
        Refusal{"at most 51.197", [](auto& d) { d.pairs[0].a = 52e-3; },
                [](auto& d) { d.pairs[0].a = 51.197e-3; }},
        Refusal{"must be above the difference of the base radii, 47.92",
                [](auto& d) { d.pairs[0].a = 40e-3; },
                {}},
        Refusal{"their sum must be below 1.04", [](auto& d) { d.gears[0].x = 1.5; },
                [](auto& d) { d.gears[0].x = 0.3; }},
        Refusal{"cuts into the root or the tips of pinion; tip_diameter of at least 141.061",
                [](auto& d) { d.gears[1].r_a = 69.9e-3; }, [](auto& d) { d.gears[1].r_a = 141.062e-3 / 2; }},
        Refusal{"must be between those of base and root", [](auto& d) { d.gears[1].r_a = 66e-3; }, {}},
        Refusal{"must be between those of base and root", [](auto& d) { d.gears[1].r_a = 76e-3; }, {}},
        Refusal{"reaches the root of ring; tip_diameter below 47.40",
                [](auto& d) { d.gears[0].r_a = 23.9e-3; },
                {}},
        Refusal{"pinion: the tip, diameter 47.2 mm, cuts into the root or the tips of ring",
                [](auto& d) { d.gears[0].r_a = 23.6e-3; }, [](auto& d) { d.gears[0].r_a = 46.6e-3 / 2; }},
        Refusal{"contact ratio", [](auto& d) { d.gears[0].r_a = 21.5e-3, d.gears[1].r_a = 73e-3; }, {}},
        Refusal{"a cutter of 71 teeth trims the tips, diameter 141.17",
                [](auto& d) { d.gears[1].cutter.z_0 = 71; }, [](auto& d) { d.gears[1].cutter.z_0 = 25; }},
        Refusal{"the cutter of 8 teeth is pointed; cutter_teeth: 25 would do",
                [](auto& d) { d.gears[1].cutter.z_0 = 8; },
                {}},
        Refusal{"cutter_teeth = 90: must be 5 to 71", [](auto& d) { d.gears[1].cutter.z_0 = 90; }, {}},
        Refusal{"cutter_tip_radius = 0.9: must be between 0.05 and 0.278",
                [](auto& d) { d.gears[1].cutter.rho_a0 = 0.9; },
                [](auto& d) { d.gears[1].cutter.rho_a0 = 0.278; }},
        Refusal{"cutter_tip_radius = nan", [](auto& d) { d.gears[1].cutter.rho_a0 = std::nan(""); }, {}},
        Refusal{
            "pinion: is external, which no cutter_teeth", [](auto& d) { d.gears[0].cutter.z_0 = 12; }, {}},
        Refusal{"outer_diameter = 140 mm: must be at least 153.8",
                [](auto& d) { d.gears[1].blank.outer_diameter = 140e-3; },
                [](auto& d) { d.gears[1].blank.outer_diameter = 153.81e-3; }},
        Refusal{"outer_diameter = nan", [](auto& d) { d.gears[1].blank.outer_diameter = std::nan(""); }, {}},
        Refusal{"rim_diameter = 140 mm: must be between 153.8",
                [](auto& d) { d.gears[1].blank.rim_diameter = 140e-3; },
                {}},
        Refusal{
            "ring: an internal gear has neither bore", [](auto& d) { d.gears[1].blank.bore = 40e-3; }, {}},
        Refusal{"outer_diameter = 40 mm: only internal gears",
                [](auto& d) { d.gears[0].blank.outer_diameter = 40e-3; },
                {}},
        Refusal{"the centre distance leaves 0.136", [](auto& d) { d.j_n = 1e-6, d.pairs[0].a = 51e-3; },
                [](auto& d) { d.j_n = 0.137e-3; }},
        Refusal{"ring: the cutter of 25 teeth is pointed; take a profile_shift nearer to 0",
                [](auto& d) { d.gears[1].x = -2; }, [](auto& d) { d.gears[1].x = -1; }}));

TEST(PlanetsRefusal, names_the_direction_that_would_do) {
  CylindricalDrive d = planets(24, 24, 72, 3);
  d.pairs[1].direction += 0.4 * 2 * pi / 96;
  expect_refused(d, "planet_2_direction: 120.00");
  d = planets(24, 23, 70, 3);
  expect_refused(d, "multiple of the number of planets");
  d = planets(24, 24, 72, 3);
  d.pairs.push_back(d.pairs.back());
  expect_refused(d, "planet_3:ring: is there twice");
  d = planets(24, 24, 72, 6);
  expect_refused(d, "are not in mesh, and overlap");
}

}  // namespace
}  // namespace elastogear::gear::internal_refusal_test
