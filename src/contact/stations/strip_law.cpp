#include "elastogear/contact/strip_law.h"

#include <cmath>
#include <numbers>

#include "elastogear/contact/strip_kernel.h"

namespace elastogear::contact {
namespace {

// Half width of the even pressure over that of H. Hertz's ellipse with the same displacement on the centre
// line.
const double kEvenWidth = std::sqrt(std::numbers::e) / 2;

// t = q / D. Eq. (6.40a).
double relative_width(const StripLaw& law, double f) { return kEvenWidth * law.half_width(f) / law.length; }

}  // namespace

double StripLaw::half_width(double f) const { return 2 * std::sqrt(compliance * radius * f / length); }

double StripLaw::pressure(double f) const {
  return f > 0 ? 2 * f / (std::numbers::pi * length * half_width(f)) : 0;
}

double StripLaw::energy(double f) const {
  if (f <= 0) return 0;
  const double t = relative_width(*this, f);
  return 2 * compliance * f * f / length * own_kernel_moment(t) / std::pow(t, 4);
}

// U depends on t = q / D alone beside f, and t^2 on R.
double StripLaw::energy_by_radius(double f) const {
  if (f <= 0) return 0;
  const double t = relative_width(*this, f);
  return compliance * f * f / (length * radius) * (own_kernel(t) - 4 * own_kernel_moment(t) / std::pow(t, 4));
}

double StripLaw::approach(double f) const { return f > 0 ? secant(f) * f : 0; }

double StripLaw::slope(double f) const {
  const double t = relative_width(*this, f);
  return compliance / length * (own_kernel(t) + t / 2 * own_kernel_slope(t));
}

double StripLaw::secant(double f) const { return compliance / length * own_kernel(relative_width(*this, f)); }

}  // namespace elastogear::contact
