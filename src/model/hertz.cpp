#include "elastogear/model/hertz.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace elastogear::model {

using std::numbers::pi;

Curvatures principal_curvatures(const Eigen::Matrix3d& Q, const Eigen::Vector3d& n) {
  const Eigen::Vector3d u = n.unitOrthogonal(), v = n.cross(u);
  Eigen::Matrix<double, 3, 2> T;
  T << u, v;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(T.transpose() * Q * T);
  return {axes.eigenvalues()[0], axes.eigenvalues()[1], T * axes.eigenvectors().col(0)};
}

HertzPatch hertz_line(double w, double kappa, double E_star) {
  const double b = std::sqrt(4 * w / (pi * E_star * kappa));
  return {2 * w / (pi * b), b};
}

double HertzEllipse::a(double F) const {
  return std::cbrt(3 * F * (K - E) / (2 * pi * E_star * (1 - k * k) * A));
}

double HertzEllipse::pressure(double F) const { return 3 * F / (2 * pi * k * a(F) * a(F)); }

double HertzEllipse::approach(double F) const { return pressure(F) * k * a(F) * K / E_star; }

HertzEllipse hertz_ellipse(double A, double B, double E_star) {
  HertzEllipse h{A, E_star, 0, 0, 0};
  double low = 1e-3, high = 1 - 1e-6;
  while (high - low > 1e-12) {
    h.k = (low + high) / 2;
    const double e = std::sqrt(1 - h.k * h.k);
    h.K = std::comp_ellint_1(e);
    h.E = std::comp_ellint_2(e);
    ((h.E / (h.k * h.k) - h.K) / (h.K - h.E) > B / A ? low : high) = h.k;
  }
  return h;
}

}  // namespace elastogear::model
