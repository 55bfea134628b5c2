#pragma once
// Fatigue strength: S-N curves, mean stress and linear damage (docs/life.md). Stresses in Pa.

#include <vector>

#include "elastogear/life/rainflow.h"

namespace elastogear::life {

/// What an S-N curve does below the stress of its knee.
enum class BelowKnee {
  original,    ///< goes on with its slope k
  haibach,     ///< goes on with the slope 2 k - 1
  elementary,  ///< smaller amplitudes do no damage
};

/// Basquin's line N = N_D (sigma_D / sigma_a)^k above the knee.
struct SnCurve {
  double knee_stress = 0;    ///< sigma_D, Pa, stress amplitude
  double knee_cycles = 1e6;  ///< N_D
  double slope = 5;          ///< k
  BelowKnee below = BelowKnee::haibach;
  double ratio = -1;      ///< smallest over largest stress at which it was found
  double survival = 0.5;  ///< probability of survival for which it holds
  double scatter = 1;     ///< T_sigma: amplitude at 10 % survival over that at 90 %, log-normal
};

/// Throws Error, naming the value and what is allowed.
void check(const SnCurve& curve);

/// The value that a standard normal variable stays below with this probability.
double normal_quantile(double probability);

/// The same curve for another probability of survival: its stress times
/// scatter^((u(given) - u(wanted)) / (u(0.9) - u(0.1))), u the normal quantile.
SnCurve at_survival(SnCurve curve, double survival);

/// Cycles to failure at an amplitude > 0; infinite where it does no damage.
double cycles_to_failure(const SnCurve& curve, double amplitude);

/// How a mean stress changes what an amplitude does.
struct MeanStress {
  enum class Kind { none, goodman, fkm };
  Kind kind = Kind::none;
  double tensile_strength =
      0;  ///< R_m, Pa, of Goodman's line, and the most that a mean may be by FKM; 0: not given
  double sensitivity = 0;  ///< M of FKM, 0 <= M < 1
};

/// M of rolled or forged steel by the FKM guideline: 0.35 R_m / (1000 MPa) - 0.1, at least 0.
double fkm_sensitivity_of_steel(double tensile_strength);

/// Throws Error, naming the value and what is allowed.
void check(const MeanStress& mean_stress);

/// The fully reversed amplitude that does the damage of this amplitude about this mean, Pa; infinite where
/// the mean reaches the tensile strength. Goodman takes no credit for compression.
double equivalent_amplitude(const MeanStress& mean_stress, double amplitude, double mean);

/// The same curve for fully reversed stress, ratio -1.
SnCurve fully_reversed(SnCurve curve, const MeanStress& mean_stress);

/// Sum of count / N over the cycles, by Palmgren and Miner. curve: for fully reversed stress.
double damage(const std::vector<Cycle>& cycles, const SnCurve& curve, const MeanStress& mean_stress);

}  // namespace elastogear::life
