#pragma once
// The approach of two flanks below their meshes, as a function of the force between them.

namespace elastogear::dynamics {

/// e(F) = c ((F + F_0)^m - F_0^m), F_0 = kTouch F_n: through e_n at F_n with the exponent m of the patch
/// there, and with a finite slope at touch. docs/theory, Eq. (6.37).
struct ApproachLaw {
  static constexpr double kTouch = 1e-2;

  double F_n = 0;  ///< N, of the state that it was found in; 0: there is none
  double e_n = 0;  ///< m, approach at F_n
  double m = 1;    ///< -, 2/3 of an ellipse, nearly 1 of a line

  double value(double F) const;                 ///< m
  double slope(double F) const;                 ///< m/N
  double energy(double F) const;                ///< J, stored: the integral of the force over the approach
  double complementary_energy(double F) const;  ///< J, the integral of the approach over the force
};

}  // namespace elastogear::dynamics
