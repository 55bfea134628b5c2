#pragma once
// Linear viscoelasticity by a generalised Maxwell model (docs/theory, Eq. (1.9)): shear and bulk modulus
//   G(t) = G_0 (1 - sum_i g_i (1 - exp(-t/tau_i))),   K(t) = K_0 (1 - sum_i k_i (1 - exp(-t/tau_i))).

#include <string>
#include <vector>

namespace elastogear::model {

/// Temperature dependence of relaxation times, tau_i(T) = a_T tau_i(T_ref). wlf (M. L. Williams, R. F.
/// Landel, J. D. Ferry, J. Am. Chem. Soc. 77 (1955) 3701-3707): log10 a_T = -C_1 (T - T_ref)/(C_2 + T -
/// T_ref). arrhenius: ln a_T = E_a/R (1/T - 1/T_ref).
struct TemperatureShift {
  enum class Law { none, wlf, arrhenius };
  Law law = Law::none;
  double C_1 = 0;        ///< -
  double C_2 = 0;        ///< K
  double E_a = 0;        ///< J/mol, activation energy
  double T_ref = 0;      ///< K, temperature of the times tau_i
  double T = 0;          ///< K, temperature of the material
  double T_least = 0;    ///< K, T_least to T_most: temperatures for which the shift is known
  double T_most = 1e30;  ///< K
};

/// a_T, Eq. (1.11); 1 without a law.
double shift_factor(const TemperatureShift& shift);

/// A Prony series. Both moduli have the same times; a term may leave one of them out (g_i or k_i = 0).
/// g = k: Poisson's ratio is constant.
struct Viscoelastic {
  std::vector<double> g, k;  ///< -, relative moduli G_i/G_0 and K_i/K_0, of the instantaneous ones
  std::vector<double> tau;   ///< s, relaxation times at shift.T_ref
  TemperatureShift shift = {};

  bool has_constant_ratio() const { return g == k; }
};

/// Throws Error that begins with `who` unless relative moduli lie in 0..1, their sums below 1, times are
/// positive and the temperature is within the range of the shift.
void validate(const Viscoelastic& material, const std::string& who);

/// tau_i at the temperature of the material, s.
std::vector<double> relaxation_times(const Viscoelastic& material);

/// Parts of the isotropic moduli that relax in the same way: both, or one of them.
enum class ModulusPart { both, shear, bulk };

}  // namespace elastogear::model
