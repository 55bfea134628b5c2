#pragma once
// The local compliance of one station: both half-spaces below its own pressure, whose half width
// follows from the force as H. Hertz's does (docs/theory.md, section 6.18).

namespace elastogear::contact {

/// The own part of one station's potential, U(f) of Eq. (6.38), for f >= 0.
struct StripLaw {
  double length;      ///< m, D: of the strip along the line of contact
  double radius;      ///< m, R > 0: of relative curvature across the line
  double compliance;  ///< 1/Pa, k: the sum of (1 - nu^2) / (pi E) of both bodies

  double half_width(double f) const;        ///< m, b: of H. Hertz's line contact. Eq. (6.40a)
  double pressure(double f) const;          ///< Pa, largest. Eq. (6.41c)
  double energy(double f) const;            ///< J, U. Eq. (6.41b)
  double energy_by_radius(double f) const;  ///< N, dU/dR
  double approach(double f) const;          ///< m, U'. Eq. (6.41)
  double slope(double f) const;             ///< m/N, U''; grows as -ln f towards f = 0. Eq. (6.41)
  double secant(double f) const;            ///< m/N, U'/f > U'': with the width left as it is. Eq. (6.41)
};

}  // namespace elastogear::contact
