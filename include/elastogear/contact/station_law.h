#pragma once
// The law of one station: how its own pressure displaces it, whose size follows from the force as H.
// Hertz has it (docs/theory, section 6.18).

#include <optional>

#include "elastogear/model/hertz.h"

namespace elastogear::contact {

/// The own part of one station's potential, U(f) of Eq. (6.38), for f >= 0: of a strip of a line of contact
/// beyond what a pressure of the half width q does, or all of a point of contact. It is convex.
struct StationLaw {
  double length;      ///< m, D: of the strip along the line of contact; of a point not read
  double radius;      ///< m, R > 0: of relative curvature across the line, the smaller one at a point
  double compliance;  ///< 1/Pa, k: the sum of (1 - nu^2) / (pi E) of both bodies
  double q;           ///< m, half width of the pressures in C; of a point not read
  std::optional<model::HertzEllipse> ellipse = {};  ///< of a point of contact

  double half_width(double f) const;        ///< m, b: of H. Hertz's contact. Eq. (6.40a)
  double area(double f) const;              ///< m^2, under pressure
  double pressure(double f) const;          ///< Pa, largest. Eq. (6.41c)
  double energy(double f) const;            ///< J, U. Eqs. (6.41) and (6.53)
  double energy_by_radius(double f) const;  ///< N, dU/dR of a strip
  double approach(double f) const;          ///< m, U'. Eqs. (6.41) and (6.53)
  double slope(double f) const;             ///< m/N, U''; infinite at f = 0. Eqs. (6.41) and (6.53)
  double secant(double f) const;            ///< m/N, U'/f >= U'': with the size left as it is
};

/// At a point with the relative curvatures least <= largest, 1/m. Eq. (6.53).
StationLaw point_law(double least, double largest, double compliance);

}  // namespace elastogear::contact
