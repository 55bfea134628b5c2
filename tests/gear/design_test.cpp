#include "elastogear/gear/design.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "../message_of.h"
#include "elastogear/base/error.h"
#include "elastogear/gear/size.h"

namespace elastogear::gear::design_test {
namespace {

constexpr double kRoundoff = 1e-12;
constexpr double kPrinted = 5e-7;  // half of the last digit of the reference design's diameters in m
constexpr double kDegree = std::numbers::pi / 180;

TEST(Design, defaults_give_the_reference_design) {
  const Geometry g = derive(Design{});
  EXPECT_NEAR(g.gamma / kDegree, 15.620493, 5e-7);
  EXPECT_NEAR(2 * g.worm.r, 14.855e-3, kPrinted);
  EXPECT_NEAR(2 * g.worm.r_a, 18.855e-3, kPrinted);
  EXPECT_NEAR(2 * g.worm.r_f, 9.855e-3, kPrinted);
  EXPECT_NEAR(2 * g.wheel.r, 85.145e-3, kPrinted);
  EXPECT_NEAR(2 * g.wheel.r_a, 89.145e-3, kPrinted);
  EXPECT_NEAR(2 * g.wheel.r_f, 80.145e-3, kPrinted);
  EXPECT_NEAR(g.epsilon, 2.19, 0.005);
  EXPECT_EQ(g.ratio, 20.5);
}

TEST(Geometry, closes_the_centre_distance_and_shares_the_normal_base_pitch) {
  const Design d;
  const Geometry g = derive(d);
  EXPECT_NEAR(g.worm.r + g.wheel.r, d.a, kRoundoff * d.a);
  for (const Toothing& t : {g.worm, g.wheel})
    EXPECT_NEAR(2 * std::numbers::pi / t.z * t.r_b * std::cos(t.beta_b), g.p_bn, kRoundoff * g.p_bn);
  EXPECT_NEAR(2 * std::numbers::pi * g.worm.p, d.z1 * g.p_x, kRoundoff * g.p_x);
}

// A catalogue's drive: a 160, m_x 6.3, d1 63, z 1:40, x2 0.397.
TEST(Geometry, of_a_shifted_wheel_has_the_drawn_diameters_and_shares_the_normal_base_pitch) {
  const double m_x = 6.3e-3, gamma = std::atan(0.1), m_n = m_x * std::cos(gamma);
  const double x2 = 160 / 6.3 - 25;
  Design d = proportioned(m_n, std::numbers::pi / 9, 1, 40, 160e-3, x2);
  d.addendum = m_x, d.dedendum = 1.25 * m_x;
  for (FlankForm form : {FlankForm::ZI, FlankForm::ZK}) {
    d.flank = form, d.wheel_form = form == FlankForm::ZI ? WheelForm::helical : WheelForm::throated;
    d.face_width = 40e-3;
    const Geometry g = derive(d);
    EXPECT_NEAR(2 * (g.worm.r - g.shift), 63e-3, 1e-9);
    EXPECT_NEAR(2 * g.worm.r_a, 75.6e-3, 1e-9);
    EXPECT_NEAR(2 * g.wheel.r, 252e-3, 1e-9);
    EXPECT_NEAR(2 * g.wheel.r_a, (252 + 2 * 6.3 * (1 + x2)) * 1e-3, 1e-9);
    EXPECT_NEAR(g.worm.r + g.wheel.r, d.a, 1e-12);
    EXPECT_NEAR(g.p_x, std::numbers::pi * m_x, 1e-12);
    if (form != FlankForm::ZI) continue;
    for (const Toothing& t : {g.worm, g.wheel})
      EXPECT_NEAR(2 * std::numbers::pi / t.z * t.r_b * std::cos(t.beta_b), g.p_bn, kRoundoff * g.p_bn);
  }
}

TEST(Geometry, takes_half_the_backlash_from_each_body) {
  Design tight;
  tight.j_n = 0;
  const Geometry with = derive(Design{}), without = derive(tight);
  const double loss_1 = (psi(without.worm, with.worm.r) - psi(with.worm, with.worm.r)) * with.worm.r_b *
                        std::cos(with.worm.beta_b);
  const double loss_2 = (psi(without.wheel, with.wheel.r) - psi(with.wheel, with.wheel.r)) * with.wheel.r_b *
                        std::cos(with.wheel.beta_b);
  EXPECT_NEAR(2 * (loss_1 + loss_2), Design{}.j_n, kRoundoff);
}

TEST(FlankDistance, is_0_on_the_flank_and_grows_by_the_step_along_its_normal) {
  const Geometry g = derive(Design{});
  for (const Toothing& t : {g.worm, g.wheel})
    for (int side : {-1, 1}) {
      const auto point = [&](double r, double z) {
        const double theta = tooth_angle(t, 1) + z / t.p + side * psi(t, r);
        return Eigen::Vector3d(r * std::cos(theta), r * std::sin(theta), z);
      };
      const double r = t.r, z = 1e-3, h = 1e-7;
      const Eigen::Vector3d x = point(r, z);
      const Eigen::Vector3d n =
          side * (point(r, z + h) - point(r, z - h)).cross(point(r + h, z) - point(r - h, z)).normalized();
      EXPECT_NEAR(flank_distance(t, 1, side, x), 0, kRoundoff * r);
      const double step = flank_distance(t, 1, side, x + 1e-6 * n);
      EXPECT_NEAR(std::abs(step), 1e-6, 1e-6 * 1e-3);  // curvature: step/radius of curvature
    }
}

TEST(FlankDistance, is_negative_inside_the_tooth_on_both_sides) {
  const Geometry g = derive(Design{});
  for (const Toothing& t : {g.worm, g.wheel})
    for (int side : {-1, 1}) {
      const double theta = tooth_angle(t, 0);
      EXPECT_LT(flank_distance(t, 0, side, {t.r * std::cos(theta), t.r * std::sin(theta), 0}), 0);
      EXPECT_GT(flank_distance(t, 0, side, {t.r * std::cos(theta + side), t.r * std::sin(theta + side), 0}),
                0);
    }
}

struct Refusal {
  const char* message;  // that must occur
  std::function<void(Design&)> change;
};
void PrintTo(const Refusal& refusal, std::ostream* os) { *os << refusal.message; }

class DesignRefusal : public testing::TestWithParam<Refusal> {};

TEST_P(DesignRefusal, names_the_value_and_what_is_allowed) {
  Design d;
  GetParam().change(d);
  try {
    derive(d);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(GetParam().message), std::string::npos) << error.what();
  }
}

struct Remedy {
  const char* value;  // that the refusal names
  std::function<void(Design&)> change;
  double Design::*named;
  double unit = 1;
};
void PrintTo(const Remedy& remedy, std::ostream* os) { *os << remedy.value; }

class DesignRemedy : public testing::TestWithParam<Remedy> {};

// A refused design is accepted once it has the value that the refusal names.
TEST_P(DesignRemedy, does) {
  const Remedy& remedy = GetParam();
  Design d;
  remedy.change(d);
  const std::string message = test::message_of([&] { derive(d); });
  const std::string before = std::string("others kept: ") + remedy.value + " = ";
  const auto at = message.find(before);
  ASSERT_NE(at, std::string::npos) << message;
  d.*remedy.named = std::stod(message.substr(at + before.size())) * remedy.unit;
  EXPECT_NO_THROW(derive(d));
}

INSTANTIATE_TEST_SUITE_P(
    All, DesignRemedy,
    testing::Values(
        Remedy{"pressure_angle", [](Design& d) { d.alpha_n = 10 * kDegree; }, &Design::alpha_n, kDegree},
        Remedy{"worm_fillet", [](Design& d) { d.worm_fillet = 1.6e-3; }, &Design::worm_fillet},
        Remedy{"pressure_angle", [](Design& d) { d.worm_fillet = 0.2e-3; }, &Design::alpha_n, kDegree},
        Remedy{"wheel_rack_tip", [](Design& d) { d.wheel_rack_tip = 1.5e-3; }, &Design::wheel_rack_tip},
        Remedy{"addendum", [](Design& d) { d.addendum = 0.5e-3; }, &Design::addendum}));

INSTANTIATE_TEST_SUITE_P(
    All, DesignRefusal,
    testing::Values(
        Refusal{"no lead angle for centre_distance = 0.04", [](Design& d) { d.a = 40e-3; }},
        Refusal{"undercut", [](Design& d) { d.alpha_n = 10 * kDegree; }},
        Refusal{"pointed",
                [](Design& d) { d.addendum = 2.9e-3, d.dedendum = 3e-3, d.alpha_n = 28 * kDegree; }},
        Refusal{"worm_fillet = 0.001", [](Design& d) { d.worm_fillet = 1.6e-3; }},
        Refusal{"worm_fillet = 0.0002 m does not reach", [](Design& d) { d.worm_fillet = 0.2e-3; }},
        Refusal{"wheel_rack_tip = 0.0015 m does not fit", [](Design& d) { d.wheel_rack_tip = 1.5e-3; }},
        Refusal{"thread_length = 0.07", [](Design& d) { d.thread_length = 70e-3; }},
        Refusal{"thread_length = 0.002", [](Design& d) { d.thread_length = 2e-3; }},
        Refusal{"worm_bore = 0.0099", [](Design& d) { d.worm_bore = 9.9e-3; }},
        Refusal{"worm_bore = 0 m: must be positive", [](Design& d) { d.worm_bore = 0; }},
        Refusal{"shoulder = 0.0001 m: too short", [](Design& d) { d.shoulder = 0.1e-3; }},
        Refusal{"seat_1_begin", [](Design& d) { d.seat_1_begin = -61e-3; }},
        Refusal{"seat_2_end", [](Design& d) { d.seat_2_end = 36e-3; }},
        Refusal{"must be finite", [](Design& d) { d.shaft_2_end = std::numeric_limits<double>::infinity(); }},
        Refusal{"module = nan", [](Design& d) { d.m_n = std::nan(""); }},
        Refusal{"pressure_angle = nan", [](Design& d) { d.alpha_n = std::nan(""); }},
        Refusal{"centre_distance = -0.05", [](Design& d) { d.a = -50e-3; }},
        Refusal{"z1 = 0", [](Design& d) { d.z1 = 0; }}, Refusal{"z2 = 1:", [](Design& d) { d.z2 = 1; }},
        Refusal{"backlash = -", [](Design& d) { d.j_n = -1e-6; }},
        Refusal{"dedendum", [](Design& d) { d.dedendum = d.addendum; }},
        Refusal{"contact ratio", [](Design& d) { d.addendum = 0.5e-3; }},
        Refusal{"rim_diameter", [](Design& d) { d.rim_diameter = 81e-3; }},
        Refusal{"hub_diameter", [](Design& d) { d.wheel_bore = 37e-3; }},
        Refusal{"web_width", [](Design& d) { d.web_width = 17e-3; }}));

TEST(Size, refuses_unknown_names_with_the_known_ones) {
  EXPECT_EQ(size("paper"), Size::paper);
  EXPECT_THROW(
      {
        try {
          size("huge");
        } catch (const Error& error) {
          EXPECT_NE(std::string(error.what()).find("'huge'; the sizes are tiny"), std::string::npos);
          throw;
        }
      },
      Error);
}

}  // namespace
}  // namespace elastogear::gear::design_test
