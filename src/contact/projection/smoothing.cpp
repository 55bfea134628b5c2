#include "contact/projection/smoothing.h"

#include <array>

#include "contact/projection/node_normals.h"

namespace elastogear::contact {
namespace {

// On [-1, 1]: value 1 at `end`, 0 at the other, no slopes (cubic Hermite).
double hermite_value(double end, double t) {
  const double s = end * t;
  return 0.25 * (2 + 3 * s - s * s * s);
}

// Slope 1 at `end`, no slope at the other, values 0.
double hermite_slope(double end, double t) {
  const double s = end * t;
  return 0.25 * end * (1 + s) * (1 + s) * (s - 1);
}

double on_quadrilateral(const CornerSlopes& slopes, double u, double v) {
  constexpr std::array<double, 4> kU{-1, 1, 1, -1}, kV{-1, -1, 1, 1};
  double sum = 0;
  for (int c = 0; c < 4; ++c)
    sum += slopes(0, c) * hermite_slope(kU[c], u) * hermite_value(kV[c], v) +
           slopes(1, c) * hermite_value(kU[c], u) * hermite_slope(kV[c], v);
  return sum;
}

// Cubic with the corners' slopes along the sides and quadratic precision (the patch of Vlachos et al. 2001).
double on_triangle(const CornerSlopes& slopes, double u, double v) {
  const Eigen::Vector3d w(1 - u - v, u, v);
  double sum = 0, all = 0;
  for (int i = 0; i < 3; ++i)
    for (int j : {(i + 1) % 3, (i + 2) % 3}) {
      const Eigen::Vector2d along = Eigen::Vector2d(j == 1, j == 2) - Eigen::Vector2d(i == 1, i == 2);
      const double slope = slopes.col(i).dot(along);
      sum += slope * w[i] * w[i] * w[j];
      all += slope;
    }
  return sum + 0.5 * all * w[0] * w[1] * w[2];
}

// Slopes of the height at the corners of a face with these normals there.
CornerSlopes slopes_of(const SurfaceView& surface, int f, const CornerNormals& smooth) {
  CornerSlopes slopes = CornerSlopes::Zero();
  Face face = face_of(surface, f);
  face.extension = {};
  for (int c = 0; c < face.sides; ++c) {
    const Eigen::Vector2d at = extended_corner(face, c);
    const Shape s = shape(face.sides, at[0], at[1]);
    const double along = smooth.col(c).dot(normal(face, at[0], at[1]));
    if (along <= 0) continue;  // a degenerate corner
    slopes.col(c) << -smooth.col(c).dot(combine(face, s.N_u)) / along,
        -smooth.col(c).dot(combine(face, s.N_v)) / along;
  }
  return slopes;
}

}  // namespace

std::vector<CornerSlopes> corner_slopes(const SurfaceView& undeformed, double feature_angle) {
  const std::vector<CornerNormals> normals = corner_normals(undeformed, feature_angle);
  std::vector<CornerSlopes> slopes;
  for (int f = 0; f < undeformed.face.cols(); ++f) slopes.push_back(slopes_of(undeformed, f, normals[f]));
  return slopes;
}

double smooth_height(int sides, const CornerSlopes& slopes, double u, double v) {
  return sides == 4 ? on_quadrilateral(slopes, u, v) : on_triangle(slopes, u, v);
}

}  // namespace elastogear::contact
