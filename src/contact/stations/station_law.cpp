#include "elastogear/contact/station_law.h"

#include <cmath>
#include <numbers>

#include "elastogear/contact/strip_kernel.h"

namespace elastogear::contact {
namespace {

using std::numbers::pi;

// Half width of the even pressure over that of H. Hertz's ellipse with the same displacement on the centre
// line.
const double kEvenWidth = std::sqrt(std::numbers::e) / 2;

// t = q / D. Eq. (6.40a).
double relative_width(const StationLaw& law, double f) { return kEvenWidth * law.half_width(f) / law.length; }

}  // namespace

double StationLaw::half_width(double f) const {
  if (ellipse) return ellipse->k * ellipse->a(f);
  return 2 * std::sqrt(compliance * radius * f / length);
}

double StationLaw::area(double f) const {
  return ellipse ? pi * half_width(f) * ellipse->a(f) : 2 * half_width(f) * length;
}

double StationLaw::pressure(double f) const {
  if (!(f > 0)) return 0;
  return ellipse ? ellipse->pressure(f) : 2 * f / (pi * length * half_width(f));
}

// The approach of a point of contact grows with f^(2/3).
double StationLaw::energy(double f) const {
  if (f <= 0) return 0;
  if (ellipse) return 3. / 5 * f * ellipse->approach(f);
  const double t = relative_width(*this, f);
  return 2 * compliance * f * f / length * own_kernel_moment(t) / std::pow(t, 4);
}

// U depends on t = q / D alone beside f, and t^2 on R.
double StationLaw::energy_by_radius(double f) const {
  if (f <= 0) return 0;
  const double t = relative_width(*this, f);
  return compliance * f * f / (length * radius) * (own_kernel(t) - 4 * own_kernel_moment(t) / std::pow(t, 4));
}

double StationLaw::approach(double f) const { return f > 0 ? secant(f) * f : 0; }

double StationLaw::slope(double f) const {
  if (ellipse) return 2. / 3 * secant(f);
  const double t = relative_width(*this, f);
  return compliance / length * (own_kernel(t) + t / 2 * own_kernel_slope(t));
}

double StationLaw::secant(double f) const {
  if (ellipse) return ellipse->approach(f) / f;
  return compliance / length * own_kernel(relative_width(*this, f));
}

StationLaw point_law(double least, double largest, double compliance) {
  const double E_star = 1 / (pi * compliance);
  return {0, 1 / largest, compliance, model::hertz_ellipse(least / 2, largest / 2, E_star)};
}

}  // namespace elastogear::contact
