#include "elastogear/dynamics/bushing.h"

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"

namespace elastogear::dynamics {
namespace {

using body::MarkerMotion;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kSeries = 0.02;  // of 1 - cos: below, 8 terms are exact to roundoff
constexpr int kTerms = 8;

// g = angle / sin(angle) as a function of the cosine, and its first two derivatives.
struct Stretch {
  double g, g_1, g_2;
};

// g = sum n! / (2n+1)!! (1 - c)^n near c = 1; else g' = (c g - 1)/(1 - c^2).
Stretch stretch(double c) {
  const double y = 1 - c;
  if (y < kSeries) {
    Stretch s{0, 0, 0};
    double b = 1, power = 1;  // coefficient, y^n
    for (int n = 0; n < kTerms; ++n) {
      const double next = b * (n + 1) / (2 * n + 3), second = next * (n + 2) / (2 * n + 5);
      s.g += b * power;
      s.g_1 -= (n + 1) * next * power;
      s.g_2 += (n + 1) * (n + 2) * second * power;
      b = next;
      power *= y;
    }
    return s;
  }
  const double sine_2 = 1 - c * c, g = std::acos(c) / std::sqrt(sine_2), g_1 = (c * g - 1) / sine_2;
  return {g, g_1, (g + 3 * c * g_1) / sine_2};
}

// Relative motion, components in the world but for those of the state.
struct Relative {
  Matrix3d A;       // axes
  Vector3d r, v_r;  // from first to second; rate of it as seen from the first
  Vector3d w_r;
};

Relative relative(const Bushing& bushing, const MarkerMotion& first, const MarkerMotion& second) {
  const Vector3d r = second.x - first.x;
  return {first.R * bushing.A_1, r, second.v - first.v - first.w.cross(r), second.w - first.w};
}

TiltAndTurn springs(const Bushing& bushing, const MarkerMotion& first, const MarkerMotion& second) {
  return tilt_and_turn(bushing.law.k_r, (first.R * bushing.A_1).transpose() * second.R * bushing.A_2);
}

using Change = Eigen::Matrix<double, 3, 24>;

// Columns of the derivative: x, orientation, v, w of both markers.
constexpr int kX[] = {0, 12}, kTheta[] = {3, 15}, kV[] = {6, 18}, kW[] = {9, 21};

// Difference of the columns of both markers, second minus first.
Change difference(const int (&column)[2]) {
  Change D = Change::Zero();
  D.middleCols<3>(column[0]) = -Matrix3d::Identity();
  D.middleCols<3>(column[1]).setIdentity();
  return D;
}

Change only(int column) {
  Change D = Change::Zero();
  D.middleCols<3>(column).setIdentity();
  return D;
}

}  // namespace

TiltAndTurn tilt_and_turn(const Vector3d& k_r, const Matrix3d& R) {
  const Vector3d e = R.col(2), z = Vector3d::UnitZ();
  const auto [g, g_1, g_2] = stretch(e.z());
  const double turn = std::atan2(R(1, 0) - R(0, 1), R(0, 0) + R(1, 1));
  const double S = k_r.x() * e.y() * e.y() + k_r.y() * e.x() * e.x();
  const Vector3d gradient(g * g * k_r.y() * e.x(), g * g * k_r.x() * e.y(), g * g_1 * S);
  const double xz = 2 * g * g_1 * k_r.y() * e.x(), yz = 2 * g * g_1 * k_r.x() * e.y();
  Matrix3d hessian;
  hessian << g * g * k_r.y(), 0, xz, 0, g * g * k_r.x(), yz, xz, yz, (g_1 * g_1 + g * g_2) * S;
  const Vector3d n = (z + e) / (1 + e.z());
  const Matrix3d E = skew(e), dn = (-E - n * e.cross(z).transpose()) / (1 + e.z());
  return {{-g * e.y(), g * e.x(), turn},
          -e.cross(gradient) - k_r.z() * turn * n,
          0.5 * (g * g * S + k_r.z() * turn * turn),
          -skew(gradient) * E + E * hessian * E - k_r.z() * (n * n.transpose() + turn * dn)};
}

Bushing make_bushing(const BushingLaw& law, const Matrix3d& A, const MarkerMotion& first,
                     const MarkerMotion& second) {
  return {law, first.R.transpose() * A, second.R.transpose() * A, A.transpose() * (second.x - first.x)};
}

body::Wrench BushingForce::on_first(const Vector3d& r) const {
  body::Wrench wrench;
  wrench << -force, -torque - r.cross(force);
  return wrench;
}

body::Wrench BushingForce::on_second() const {
  body::Wrench wrench;
  wrench << force, torque;
  return wrench;
}

BushingForce bushing_force(const Bushing& bushing, const MarkerMotion& first, const MarkerMotion& second) {
  const Relative rel = relative(bushing, first, second);
  const BushingLaw& law = bushing.law;
  const TiltAndTurn turned = springs(bushing, first, second);
  BushingForce state;
  state.d = rel.A.transpose() * rel.r - bushing.d_0;
  state.d_dot = rel.A.transpose() * rel.v_r;
  state.angle = turned.angle;
  state.w = rel.A.transpose() * rel.w_r;
  state.force = -rel.A * (law.k.cwiseProduct(state.d) + law.c.cwiseProduct(state.d_dot));
  state.torque = rel.A * (turned.torque - law.c_r.cwiseProduct(state.w));
  state.energy = 0.5 * state.d.dot(law.k.cwiseProduct(state.d)) + turned.energy;
  return state;
}

Eigen::Matrix<double, 12, 24> bushing_derivative(const Bushing& bushing, const MarkerMotion& first,
                                                 const MarkerMotion& second) {
  const BushingLaw& law = bushing.law;
  const Relative rel = relative(bushing, first, second);
  const BushingForce state = bushing_force(bushing, first, second);
  const Matrix3d& A = rel.A;
  const Matrix3d K = A * law.k.asDiagonal() * A.transpose(), C = A * law.c.asDiagonal() * A.transpose(),
                 C_r = A * law.c_r.asDiagonal() * A.transpose(),
                 K_r = A * springs(bushing, first, second).derivative * A.transpose();
  // Changes with respect to the axes of the bushing, which turn with the first marker.
  const Change turn = only(kTheta[0]), dr = difference(kX), d_turn = difference(kTheta);
  const Change dv_r = difference(kV) + skew(rel.r) * only(kW[0]) - skew(first.w) * dr;
  const Change d = dr + skew(rel.r) * turn, d_dot = dv_r + skew(rel.v_r) * turn;
  const Change w = difference(kW) + skew(rel.w_r) * turn;
  const Change df = -K * d - C * d_dot - skew(state.force) * turn;
  const Change dm = K_r * d_turn - C_r * w - skew(state.torque) * turn;
  Eigen::Matrix<double, 12, 24> D;
  D << -df, -dm - skew(rel.r) * df + skew(state.force) * dr, df, dm;
  return D;
}

double dissipation(const BushingLaw& law, const Vector3d& d_dot, const Vector3d& w) {
  return d_dot.dot(law.c.cwiseProduct(d_dot)) + w.dot(law.c_r.cwiseProduct(w));
}

void validate(const BushingLaw& law, const std::string& who) {
  const auto good = [](const Vector3d& v) { return v.allFinite() && (v.array() >= 0).all(); };
  require(good(law.k) && good(law.k_r), who, "stiffness (", law.k.transpose(), ") N/m, (",
          law.k_r.transpose(), ") N m/rad: must be finite and not negative");
  require(good(law.c) && good(law.c_r), who, "damping (", law.c.transpose(), ") N s/m, (",
          law.c_r.transpose(), ") N m s/rad: must be finite and not negative");
}

}  // namespace elastogear::dynamics
