#pragma once
// Contact of two elastic bodies whose patch is small beside them, by H. Hertz (1882), after K. L. Johnson,
// Contact Mechanics, chapter 4.

#include <Eigen/Core>

namespace elastogear::model {

/// b / a of an ellipse, below which two bodies are taken to touch along a line.
inline constexpr double kLeastAxes = 0.02;

/// Principal relative curvatures of two surfaces that touch, in their tangent plane.
struct Curvatures {
  double least = 0, largest = 0;  ///< 1/m; the gap is (least x^2 + largest y^2) / 2
  Eigen::Vector3d along;          ///< unit vector of x
};
/// Q: 1/m, the relative curvature, the gap is x'Q x / 2; n: unit normal.
Curvatures principal_curvatures(const Eigen::Matrix3d& Q, const Eigen::Vector3d& n);

struct HertzPatch {
  double pressure = 0;    ///< Pa, largest
  double half_width = 0;  ///< m, b, half the minor axis
  double axes = 0;        ///< b / a of an ellipse; 0: a line
};
/// Line contact of a load per length w (N/m) where the gap is kappa x^2 / 2 (1/m): Eq. (10.12).
HertzPatch hertz_line(double w, double kappa, double E_star);

/// Point contact where the gap is A x^2 + B y^2, 0 < A <= B: Eq. (6.23).
struct HertzEllipse {
  double A, E_star;  // 1/m, Pa
  double k, K, E;    // b / a and the complete elliptic integrals

  double a(double F) const;         ///< m, half the major axis under the force F (N)
  double pressure(double F) const;  ///< Pa, largest
  double approach(double F) const;  ///< m, of distant points
};
HertzEllipse hertz_ellipse(double A, double B, double E_star);

/// Largest shear stress in the bodies and how deep below the surface it is.
struct ShearBelow {
  double stress = 0;  ///< Pa
  double depth = 0;   ///< m
};
/// Of a line that slides with the coefficient of friction mu, in the plane across it, Eq. (10.13); of an
/// ellipse without friction, on its axis, for Poisson's ratio 0.3, Eq. (10.14).
ShearBelow largest_shear(const HertzPatch& patch, double mu);

}  // namespace elastogear::model
