#include "elastogear/life/fatigue.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "elastogear/base/error.h"

namespace elastogear::life {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kSteelSlope = 0.35e-9, kSteelOffset = -0.1;  // 1/Pa, -: FKM guideline, table of a_M and b_M

// Haigh's diagram of the FKM guideline, load case F2: the amplitude that is endured, over that at ratio -1.
double fkm_factor(double M, double amplitude, double mean) {
  if (mean < -amplitude) return 1 / (1 - M);
  if (mean <= amplitude) return 1 / (1 + M * mean / amplitude);
  const double third = 1 + M / 3;
  if (mean < 3 * amplitude) return third / (1 + M) / (1 + M / 3 * mean / amplitude);
  return third / ((1 + M) * (1 + M));
}

void require_positive(double value, const char* name) {
  require(std::isfinite(value) && value > 0, "S-N curve: ", name, " = ", value, " must be > 0");
}

void require_probability(double p) {
  require(p > 0 && p < 1, "probability of survival ", p, ": must lie between 0 and 1");
}

}  // namespace

void check(const SnCurve& curve) {
  require_positive(curve.knee_stress, "stress at the knee (Pa)");
  require_positive(curve.knee_cycles, "cycles at the knee");
  require(curve.slope >= 1 && curve.slope <= 100, "S-N curve: slope ", curve.slope,
          " must lie between 1 and 100");
  require(std::isfinite(curve.ratio) && curve.ratio < 1, "S-N curve: stress ratio ", curve.ratio,
          " must be < 1: smallest over largest stress, -1 fully reversed, 0 pulsating");
  require(curve.scatter >= 1 && curve.scatter < 10, "S-N curve: scatter ", curve.scatter,
          " must be the amplitude at 10 % survival over that at 90 %, 1 to 10");
  require_probability(curve.survival);
}

double normal_quantile(double probability) {
  require_probability(probability);
  double below = -40, above = 40;
  while (true) {  // ends when no number lies between
    const double middle = (below + above) / 2;
    if (middle <= below || middle >= above) return middle;
    (std::erfc(-middle / std::numbers::sqrt2) / 2 < probability ? below : above) = middle;
  }
}

SnCurve at_survival(SnCurve curve, double survival) {
  const double apart = normal_quantile(0.9) - normal_quantile(0.1);
  const double towards = normal_quantile(curve.survival) - normal_quantile(survival);
  curve.knee_stress *= std::pow(curve.scatter, towards / apart);
  curve.survival = survival;
  return curve;
}

double cycles_to_failure(const SnCurve& curve, double amplitude) {
  const double share = curve.knee_stress / amplitude;
  if (share > 1 && curve.below == BelowKnee::elementary) return kInfinite;
  const bool haibach = share > 1 && curve.below == BelowKnee::haibach;
  return curve.knee_cycles * std::pow(share, haibach ? 2 * curve.slope - 1 : curve.slope);
}

double fkm_sensitivity_of_steel(double tensile_strength) {
  return std::max(0.0, kSteelSlope * tensile_strength + kSteelOffset);
}

void check(const MeanStress& mean_stress) {
  if (mean_stress.kind == MeanStress::Kind::goodman)
    require(std::isfinite(mean_stress.tensile_strength) && mean_stress.tensile_strength > 0,
            "mean stress by Goodman: tensile strength ", mean_stress.tensile_strength, " Pa must be > 0");
  if (mean_stress.kind == MeanStress::Kind::fkm)
    require(mean_stress.sensitivity >= 0 && mean_stress.sensitivity < 1,
            "mean stress sensitivity M = ", mean_stress.sensitivity, ": must be at least 0 and below 1");
}

double equivalent_amplitude(const MeanStress& mean_stress, double amplitude, double mean) {
  if (amplitude <= 0 || mean_stress.kind == MeanStress::Kind::none) return amplitude;
  if (mean_stress.kind == MeanStress::Kind::fkm) {
    const bool breaks = mean_stress.tensile_strength > 0 && mean >= mean_stress.tensile_strength;
    return breaks ? kInfinite : amplitude / fkm_factor(mean_stress.sensitivity, amplitude, mean);
  }
  const double left = 1 - std::max(0.0, mean) / mean_stress.tensile_strength;
  return left > 0 ? amplitude / left : kInfinite;
}

SnCurve fully_reversed(SnCurve curve, const MeanStress& mean_stress) {
  const double mean = curve.knee_stress * (1 + curve.ratio) / (1 - curve.ratio);
  const double reversed = equivalent_amplitude(mean_stress, curve.knee_stress, mean);
  require(std::isfinite(reversed), "S-N curve: ", curve.knee_stress, " Pa at the stress ratio ", curve.ratio,
          " has a mean of ", mean, " Pa, which exceeds the tensile strength");
  curve.knee_stress = reversed;
  curve.ratio = -1;
  return curve;
}

double damage(const std::vector<Cycle>& cycles, const SnCurve& curve, const MeanStress& mean_stress) {
  double sum = 0;
  for (const Cycle& c : cycles) {
    const double amplitude = equivalent_amplitude(mean_stress, c.range / 2, c.mean);
    if (amplitude > 0) sum += c.count / cycles_to_failure(curve, amplitude);
  }
  return sum;
}

}  // namespace elastogear::life
