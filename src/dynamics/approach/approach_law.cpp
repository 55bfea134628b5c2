#include "dynamics/approach/approach_law.h"

#include <cmath>

namespace elastogear::dynamics {
namespace {

// c of the law.
double coefficient(const ApproachLaw& law) {
  const double F_0 = ApproachLaw::kTouch * law.F_n;
  return law.e_n / (std::pow(law.F_n + F_0, law.m) - std::pow(F_0, law.m));
}

}  // namespace

double ApproachLaw::value(double F) const {
  if (!(F_n > 0) || !(F > 0)) return 0;
  const double F_0 = kTouch * F_n;
  return coefficient(*this) * (std::pow(F + F_0, m) - std::pow(F_0, m));
}

double ApproachLaw::slope(double F) const {
  if (!(F_n > 0)) return 0;
  return coefficient(*this) * m * std::pow(std::fmax(F, 0) + kTouch * F_n, m - 1);
}

double ApproachLaw::energy(double F) const { return F * value(F) - complementary_energy(F); }

double ApproachLaw::complementary_energy(double F) const {
  if (!(F_n > 0) || !(F > 0)) return 0;
  const double F_0 = kTouch * F_n;
  return coefficient(*this) *
         ((std::pow(F + F_0, m + 1) - std::pow(F_0, m + 1)) / (m + 1) - std::pow(F_0, m) * F);
}

}  // namespace elastogear::dynamics
