#include "app/options/units.h"

#include <gtest/gtest.h>

#include "../message_of.h"

namespace elastogear::app::units_test {
namespace {

using test::message_of;

double converted(const std::string& text, const std::string& unit) {
  return std::stod(in_unit("option -x", text, unit));
}

TEST(Units, convert_numbers_to_the_unit_of_an_option) {
  EXPECT_DOUBLE_EQ(converted("3 mm", "m"), 3e-3);
  EXPECT_DOUBLE_EQ(converted("3mm", "m"), 3e-3);
  EXPECT_DOUBLE_EQ(converted("1e-3 in", "m"), 25.4e-6);
  EXPECT_DOUBLE_EQ(converted("20 deg", "deg"), 20);
  EXPECT_DOUBLE_EQ(converted("3.14159265358979312 rad", "deg"), 180);
  EXPECT_DOUBLE_EQ(converted("210 GPa", "Pa"), 210e9);
  EXPECT_DOUBLE_EQ(converted("-4000 N mm", "N m"), -4);
  EXPECT_DOUBLE_EQ(converted("30 rpm", "rad/s"), 3.14159265358979312);
  EXPECT_DOUBLE_EQ(converted("-20 degC", "K"), 253.15);
  EXPECT_DOUBLE_EQ(converted("300 K", "K"), 300);
  EXPECT_DOUBLE_EQ(converted("80 kJ/mol", "J/mol"), 8e4);
  EXPECT_DOUBLE_EQ(converted("100 mm/s", "m/s"), 0.1);
  EXPECT_DOUBLE_EQ(converted("9810 mm/s^2", "m/s^2"), 9.81);
  EXPECT_DOUBLE_EQ(converted("2 kHz", "Hz"), 2000);
}

TEST(Units, leave_plain_numbers_words_and_files_as_they_are) {
  for (const char* text :
       {"0.003", "[ramp, 4, 1e-3]", "table,torque.csv", "5.csv", "5/a.csv", "-inf", "auto"})
    EXPECT_EQ(in_unit("option -x", text, "N m"), text);
  EXPECT_EQ(in_unit("option -x", "3 mm", "-"), "3 mm");
}

TEST(Units, convert_each_number_of_a_list) {
  EXPECT_EQ(in_unit("option -x", "[1 m, 2,500 mm]", "m"), "1, 2,0.5");
  EXPECT_EQ(in_unit("option -x", "ramp, 4 kN m, 2 ms", "N m"), "ramp,4000,0.002");
}

TEST(Units, stand_in_headings_as_they_are_written) {
  for (const char* heading :
       {"torque [kN m]", "torque (kN m)", "torque(kN m)", "torque / kN m", "torque/kN m", "torque, kN m",
        "torque in kN m", " \"torque (kN m)\" ", "torque  [ kN m ]"}) {
    const Heading found = heading_of("a.csv", heading);
    EXPECT_EQ(found.name, "torque") << heading;
    EXPECT_EQ(found.unit, "kN m") << heading;
  }
  const auto unit = [](const char* heading) { return heading_of("a.csv", heading).unit; };
  EXPECT_EQ(unit("speed (1/min)"), "1/min");
  EXPECT_EQ(unit("speed / 1/min"), "1/min");
  EXPECT_EQ(unit("speed m/s"), "m/s");
  EXPECT_EQ(unit("speed in m/s"), "m/s");
  EXPECT_EQ(unit("wear (mm^3/(N m))"), "mm^3/(N m)");
  EXPECT_EQ(unit("wear / mm^3/(N m)"), "mm^3/(N m)");
  EXPECT_EQ(unit("force (mean) (kN)"), "kN");
  for (const char* none :
       {"torque", "count [1]", "count (1)", "count (-)", "time t", "m/s", "input / output"})
    EXPECT_EQ(unit(none), "") << none;
  EXPECT_EQ(heading_of("a.csv", "time t").name, "time t");
  EXPECT_TRUE(message_of([&] {
                unit("torque (lbf ft)");
              }).starts_with("a.csv: the heading 'torque (lbf ft)' ends with 'lbf ft' in parentheses"));
  EXPECT_NE(message_of([&] { unit("wear mm^3/(N ft)"); }), "");
}

TEST(Units, refuse_what_measures_something_else) {
  const auto message = [](const char* text) {
    return message_of([&] { in_unit("option -module", text, "m"); });
  };
  EXPECT_EQ(message("3 deg"),
            "option -module = '3 deg': 'deg' is no unit of it, write nm, um, mm, cm, m, in");
  EXPECT_EQ(message("3 m m"),
            "option -module = '3 m m': 'm m' is no unit of it, write nm, um, mm, cm, m, in");
  EXPECT_EQ(message("3 mm/s"),
            "option -module = '3 mm/s': 'mm/s' is no unit of it, write nm, um, mm, cm, m, in");
}

}  // namespace
}  // namespace elastogear::app::units_test
