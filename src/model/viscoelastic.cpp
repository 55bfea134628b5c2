#include "elastogear/model/viscoelastic.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "elastogear/base/error.h"

namespace elastogear::model {
namespace {

constexpr double kGasConstant = 8.31446261815324;  // J/(mol K)
constexpr double kLargestShift = 1e100;            // beyond it a time is none

void validate_moduli(const std::vector<double>& relative, const std::string& who, const char* which) {
  for (double g : relative)
    require(std::isfinite(g) && g >= 0 && g <= 1, who, ": relative ", which, " modulus ", g,
            " of the Prony series must lie in 0..1");
  const double sum = std::accumulate(relative.begin(), relative.end(), 0.0);
  require(sum < 1, who, ": relative ", which, " moduli of the Prony series sum to ", sum,
          ", must stay below 1: the rest is the long-term modulus, and Poisson's ratio would leave -1 .. 0.5 "
          "while the material relaxes");
}

void validate_law(const TemperatureShift& s, const std::string& who) {
  require(std::isfinite(s.T_ref) && s.T_ref > 0 && std::isfinite(s.T) && s.T > 0, who, ": temperature ", s.T,
          " K and reference temperature ", s.T_ref, " K must be positive");
  if (s.law == TemperatureShift::Law::wlf) {
    require(std::isfinite(s.C_1) && s.C_1 > 0 && std::isfinite(s.C_2) && s.C_2 > 0, who,
            ": WLF constants C_1 = ", s.C_1, " and C_2 = ", s.C_2, " K must be positive");
    require(s.T > s.T_ref - s.C_2, who, ": temperature ", s.T,
            " K is outside of the WLF shift, which ends at ", "T_ref - C_2 = ", s.T_ref - s.C_2, " K");
  } else {
    require(std::isfinite(s.E_a) && s.E_a > 0, who, ": activation energy ", s.E_a, " J/mol must be positive");
  }
}

void validate_shift(const TemperatureShift& s, const std::string& who) {
  if (s.law == TemperatureShift::Law::none) return;
  validate_law(s, who);
  require(s.T >= s.T_least && s.T <= s.T_most, who, ": temperature ", s.T,
          " K is outside of the range of the temperature shift, ", s.T_least, " to ", s.T_most, " K");
  const double a_T = shift_factor(s);
  require(a_T > 1 / kLargestShift && a_T < kLargestShift, who, ": at ", s.T,
          " K the temperature shift multiplies relaxation times by ", a_T,
          ", is too far from the reference temperature ", s.T_ref, " K");
}

}  // namespace

double shift_factor(const TemperatureShift& s) {
  switch (s.law) {
    case TemperatureShift::Law::wlf:
      return std::pow(10, -s.C_1 * (s.T - s.T_ref) / (s.C_2 + s.T - s.T_ref));
    case TemperatureShift::Law::arrhenius:
      return std::exp(s.E_a / kGasConstant * (1 / s.T - 1 / s.T_ref));
    case TemperatureShift::Law::none:
      break;
  }
  return 1;
}

void validate(const Viscoelastic& material, const std::string& who) {
  const auto& [g, k, tau, shift] = material;
  require(!tau.empty() && g.size() == tau.size() && k.size() == tau.size(), who, ": the Prony series has ",
          g.size(), " relative shear moduli, ", k.size(), " relative bulk moduli and ", tau.size(),
          " relaxation times: each term needs its own");
  for (double t : tau)
    require(std::isfinite(t) && t > 0, who, ": relaxation time ", t, " s must be positive");
  validate_moduli(g, who, "shear");
  validate_moduli(k, who, "bulk");
  validate_shift(shift, who);
}

std::vector<double> relaxation_times(const Viscoelastic& material) {
  std::vector<double> tau = material.tau;
  const double a_T = shift_factor(material.shift);
  for (double& t : tau) t *= a_T;
  return tau;
}

}  // namespace elastogear::model
