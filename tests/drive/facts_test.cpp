// Numbers of designs beside those of textbooks and drawings.

#include "elastogear/drive/facts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace elastogear::drive::facts_test {
namespace {

double value(const Facts& facts, const std::string& name) {
  for (const Fact& fact : facts)
    for (const Figure& figure : fact.figures)
      if (figure.name == name) return figure.value;
  return NAN;
}

// The standard pair of most textbooks: m 1 mm, without profile shift.
TEST(Facts, of_spur_gears_are_those_of_the_basic_rack) {
  gear::CylindricalDrive d;
  d.m_n = 1e-3;
  d.rack = gear::basic_rack("A");
  d.gears.resize(2);
  d.gears[0] = {.name = "pinion", .z = 20, .cutter = {}, .blank = {.face_width = 10e-3}};
  d.gears[1] = {.name = "wheel", .z = 40, .cutter = {}, .blank = {.face_width = 10e-3}};
  d.pairs = {{.first = 0, .second = 1}};
  const DriveFacts all = facts(d, gear::derive(d));
  ASSERT_EQ(all.members.size(), 2u);
  ASSERT_EQ(all.pairs.size(), 1u);
  EXPECT_NEAR(value(all.members[0], "pitch diameter"), 20e-3, 1e-12);
  EXPECT_NEAR(value(all.members[0], "tip diameter"), 22e-3, 1e-12);
  EXPECT_NEAR(value(all.members[1], "root diameter"), 37.5e-3, 1e-12);
  EXPECT_NEAR(value(all.members[1], "base diameter"), 40e-3 * std::cos(20 * std::numbers::pi / 180), 1e-12);
  EXPECT_NEAR(value(all.pairs[0], "centre distance"), 30e-3, 1e-12);
  EXPECT_NEAR(value(all.pairs[0], "contact ratio"), 1.635, 1e-3);
  EXPECT_EQ(value(all.pairs[0], "overlap ratio"), 0);
}

// A catalogue's worm: a 160 mm, m_x 6.3 mm, d_1 63 mm, x_2 0.397.
TEST(Facts, of_a_worm_drive_are_those_of_the_catalogue) {
  const double gamma = std::atan(0.1);
  const gear::Design d =
      gear::proportioned(6.3e-3 * std::cos(gamma), 20 * std::numbers::pi / 180, 1, 40, 160e-3, 0.397);
  const DriveFacts all = facts(d, gear::derive(d));
  EXPECT_NEAR(value(all.pairs[0], "axial module"), 6.3e-3, 1e-6);
  EXPECT_NEAR(value(all.pairs[0], "reference diameter"), 63e-3, 1e-5);
  EXPECT_NEAR(value(all.pairs[0], "lead angle"), gamma, 1e-5);
  EXPECT_EQ(value(all.pairs[0], "ratio"), 40);
  EXPECT_EQ(value(all.pairs[0], "friction that locks the worm"), locking_friction(gear::derive(d)));
  EXPECT_EQ(all.members[0].back().text, "ZI, right-handed");
}

}  // namespace
}  // namespace elastogear::drive::facts_test
