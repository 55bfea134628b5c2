#include "elastogear/contact/station_law.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace elastogear::contact {
namespace {

using std::numbers::pi;

// Half width of the even pressure over that of H. Hertz's ellipse with the same displacement on the centre
// line.
const double kEvenWidth = std::sqrt(std::numbers::e) / 2;

// N: under which the contact is as wide as q. Eq. (6.41).
double widest_force(const StationLaw& law) {
  return std::pow(law.q / kEvenWidth, 2) * law.length / (4 * law.compliance * law.radius);
}

// N: up to which widths grow with the force. Eq. (6.41a).
double last_growth(const StationLaw& law) { return widest_force(law) / std::numbers::e; }

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
  const double f_c = last_growth(*this);
  return compliance / length *
         (f < f_c ? f * f / 4 * (2 * std::log(widest_force(*this) / f) + 1) : f_c * (f - f_c / 4));
}

double StationLaw::energy_by_radius(double f) const {
  if (f <= 0) return 0;
  const double f_c = last_growth(*this);
  return -compliance / (length * radius) * (f < f_c ? f * f / 2 : f_c * (f - f_c / 2));
}

double StationLaw::approach(double f) const { return f > 0 ? secant(f) * f : 0; }

double StationLaw::slope(double f) const {
  if (ellipse) return 2. / 3 * secant(f);
  return compliance / length * std::max(0., std::log(widest_force(*this) / f) - 1);
}

double StationLaw::secant(double f) const {
  if (ellipse) return ellipse->approach(f) / f;
  const double f_c = last_growth(*this);
  return compliance / length * (f < f_c ? std::log(widest_force(*this) / f) : f_c / f);
}

StationLaw point_law(double least, double largest, double compliance) {
  const double E_star = 1 / (pi * compliance);
  return {0, 1 / largest, compliance, 0, model::hertz_ellipse(least / 2, largest / 2, E_star)};
}

}  // namespace elastogear::contact
