// Prony series and their shift with temperature against numbers by hand.

#include "elastogear/model/viscoelastic.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "../message_of.h"
#include "elastogear/model/material.h"

namespace elastogear::viscoelastic_test {
using namespace model;
using testing::HasSubstr;
using Law = TemperatureShift::Law;

namespace {

Viscoelastic series() { return {{0.3, 0.2}, {0.1, 0}, {1e-3, 10}}; }

TEST(Viscoelastic, shift_of_williams_landel_and_ferry) {
  TemperatureShift shift{.law = Law::wlf, .C_1 = 17.44, .C_2 = 51.6, .T_ref = 300, .T = 350};
  EXPECT_NEAR(std::log10(shift_factor(shift)), -17.44 * 50 / 101.6, 1e-12);
  shift.T = 300;
  EXPECT_EQ(shift_factor(shift), 1);
  shift.T = 280;  // colder: longer times
  EXPECT_NEAR(std::log10(shift_factor(shift)), 17.44 * 20 / 31.6, 1e-12);
}

TEST(Viscoelastic, shift_of_arrhenius_halves_times_ten_kelvin_up) {
  // E_a = R ln 2 / (1/300 K - 1/310 K)
  const double E_a = 8.31446261815324 * std::log(2) / (1 / 300. - 1 / 310.);
  Viscoelastic material = series();
  material.shift = {.law = Law::arrhenius, .E_a = E_a, .T_ref = 300, .T = 310};
  EXPECT_NEAR(shift_factor(material.shift), 0.5, 1e-12);
  EXPECT_NEAR(relaxation_times(material)[1], 5, 1e-11);
}

TEST(Viscoelastic, long_term_moduli_give_instantaneous_ones) {
  Material material{2e9, 0.4, 1100, {}, Viscoelastic{{0.5}, {0.5}, {1}}};
  EXPECT_NEAR(from_long_term(material).E, 4e9, 1);
  EXPECT_EQ(from_long_term(material).nu, 0.4);
  material.viscoelastic = Viscoelastic{{0.5}, {0}, {1}};  // the bulk modulus stays
  const Material glassy = from_long_term(material);
  const double G = 2e9 / 2.8, K = 2e9 / 0.6;
  EXPECT_NEAR(glassy.E / (2 * (1 + glassy.nu)), 2 * G, 1e-6 * G);
  EXPECT_NEAR(glassy.E / (3 * (1 - 2 * glassy.nu)), K, 1e-6 * K);
  EXPECT_LT(glassy.nu, 0.4);
}

std::string refusal(const Viscoelastic& material) {
  return test::message_of([&] { validate(material, "material of cell set 'rim'"); });
}

TEST(Viscoelastic, refuses_series_that_are_none) {
  EXPECT_EQ(refusal(series()), "no error");
  Viscoelastic m = series();
  m.g = {0.6, 0.5};
  EXPECT_THAT(refusal(m),
              testing::AllOf(HasSubstr("cell set 'rim'"), HasSubstr("sum to 1.1"), HasSubstr("Poisson")));
  m = series();
  m.k = {0.5, 0.5};
  EXPECT_THAT(refusal(m), HasSubstr("bulk moduli of the Prony series sum to 1,"));
  m = series();
  m.g[1] = -0.1;
  EXPECT_THAT(refusal(m), HasSubstr("-0.1"));
  m = series();
  m.tau[1] = -10;
  EXPECT_THAT(refusal(m), HasSubstr("relaxation time -10 s"));
  m.tau = {1};
  EXPECT_THAT(refusal(m), HasSubstr("1 relaxation times"));
}

TEST(Viscoelastic, refuses_temperatures_outside_the_shift) {
  Viscoelastic m = series();
  m.shift = {.law = Law::wlf, .C_1 = 17.44, .C_2 = 51.6, .T_ref = 300, .T = 248};
  EXPECT_THAT(refusal(m), HasSubstr("248 K is outside of the WLF shift"));
  m.shift.T = 320;
  EXPECT_EQ(refusal(m), "no error");
  m.shift.T_least = 250;
  m.shift.T_most = 310;
  EXPECT_THAT(refusal(m), HasSubstr("320 K is outside of the range of the temperature shift, 250 to 310 K"));
  m.shift = {.law = Law::arrhenius, .E_a = 1e5, .T_ref = 300, .T = -5};
  EXPECT_THAT(refusal(m), HasSubstr("-5 K"));
  m.shift.T = 300;
  m.shift.E_a = 0;
  EXPECT_THAT(refusal(m), HasSubstr("activation energy"));
  m.shift = {.law = Law::wlf, .C_1 = 17.44, .C_2 = 51.6, .T_ref = 300, .T = 248.41};
  EXPECT_THAT(refusal(m), HasSubstr("too far from the reference"));
}

}  // namespace
}  // namespace elastogear::viscoelastic_test
