// The flanks that a hob makes. Each of their points is found by iterations, and stations ask for many: half
// angles are Chebyshev polynomials over pieces of the face.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "drive/formed_flanks.h"

namespace elastogear::drive {
namespace {

using Eigen::Index;
constexpr int kAcross = 20, kAlong = 16;  // points across the profile and along a piece of the face

using Across = Eigen::Matrix<double, kAcross, 1>;
using Along = Eigen::Matrix<double, kAlong, 1>;

// Chebyshev polynomials at x from -1 to 1, and their derivatives.
template <class Vector>
Vector polynomials(double x) {
  Vector T;
  T[0] = 1;
  T[1] = x;
  for (Index k = 2; k < T.size(); ++k) T[k] = 2 * x * T[k - 1] - T[k - 2];
  return T;
}
template <class Vector>
Vector slopes(double x) {
  Vector U;
  U[0] = 1;
  U[1] = 2 * x;
  for (Index k = 2; k < U.size(); ++k) U[k] = 2 * x * U[k - 1] - U[k - 2];
  Vector dT = Vector::Zero();
  for (Index k = 1; k < U.size(); ++k) dT[k] = static_cast<double>(k) * U[k - 1];
  return dT;
}
double node(int i, int n) { return std::cos(std::numbers::pi * (i + 0.5) / n); }
// n x n: values at the nodes to coefficients.
Eigen::MatrixXd to_coefficients(int n) {
  Eigen::MatrixXd C(n, n);
  for (int k = 0; k < n; ++k)
    for (int i = 0; i < n; ++i)
      C(k, i) = (k == 0 ? 1. : 2.) / n * std::cos(std::numbers::pi * k * (i + 0.5) / n);
  return C;
}

// A piece of the face, of a flank of a left side.
struct Piece {
  double from, to;  // m, z
  // Coefficients across the profile, from r_form to r_a, and along the piece.
  Eigen::Matrix<double, kAcross, kAlong> psi;
  Along r_form, r_a;
};

Piece piece(const gear::Toothing& t, double from, double to) {
  const Eigen::MatrixXd across = to_coefficients(kAcross), along = to_coefficients(kAlong);
  Piece p{from, to, {}, {}, {}};
  for (int j = 0; j < kAlong; ++j) {
    const double z = (from + to) / 2 + (to - from) / 2 * node(j, kAlong);
    const gear::FlankEnds ends = t.ends(z);
    p.r_form[j] = ends.r_form;
    p.r_a[j] = ends.r_a;
    for (int i = 0; i < kAcross; ++i)
      p.psi(i, j) = gear::psi(t, std::lerp(ends.r_form, ends.r_a, (1 + node(i, kAcross)) / 2), z);
  }
  p.psi = (across * p.psi * along.transpose()).eval();
  p.r_form = (along * p.r_form).eval();
  p.r_a = (along * p.r_a).eval();
  return p;
}

class HobbedFlanks : public FormedFlanks {
 public:
  HobbedFlanks(const gear::Toothing& toothing, const std::optional<gear::FlankDeviations>& deviations)
      : FormedFlanks(toothing, deviations) {
    const double end = t_.half_face;
    const gear::FlankEnds middle = t_.ends(0);
    extent_ = {0, middle.r_a - middle.r_form, true, kEdgeRadius * normal_module(t_)};
    tip_ = t_.ends(end).r_a;
    std::vector<double> limits{-end, 0, end};
    if (t_.crease > 0 && t_.crease < end) limits = {-end, -t_.crease, 0, t_.crease, end};
    for (std::size_t i = 1; i < limits.size(); ++i) pieces_.push_back(piece(t_, limits[i - 1], limits[i]));
  }

  bool is_hobbed() const override { return true; }

  // v is the part of the way from r_form to r_a, times that in the middle plane.
  contact::FlankPoint point(const contact::FlankName& flank, double v, double z) const override {
    const int s = flank.side;
    const Place at = place(v / extent_.upper, s * z);
    const double theta = z / t_.p + s * at.psi + gear::tooth_angle(t_, flank.tooth);
    const Eigen::Vector3d radial(std::cos(theta), std::sin(theta), 0), around(-radial[1], radial[0], 0);
    const double theta_v = s * at.psi_u / extent_.upper, theta_z = 1 / t_.p + at.psi_z;
    return with_normal(at.r * radial + z * Eigen::Vector3d::UnitZ(),
                       at.r_u / extent_.upper * radial + at.r * theta_v * around,
                       s * at.r_z * radial + at.r * theta_z * around + Eigen::Vector3d::UnitZ(), s);
  }

  Eigen::Vector2d chart(const contact::FlankName& flank, const Eigen::Vector3d& x) const override {
    const Ends ends = ends_at(flank.side * x[2]);
    return {extent_.upper * (x.head<2>().norm() - ends.r_form) / (ends.r_a - ends.r_form), x[2]};
  }

  double tip_radius() const override { return tip_; }

 private:
  struct Ends {
    double r_form, r_a, r_form_z, r_a_z;
  };
  struct Place {
    double r, r_u, r_z;  // m
    double psi, psi_u, psi_z;
  };
  // The nearest piece; x: -1 to 1 on it.
  const Piece& piece_at(double z, double& x) const {
    auto p = std::find_if(pieces_.begin(), pieces_.end() - 1, [&](const Piece& at) { return z <= at.to; });
    x = std::clamp((2 * z - p->from - p->to) / (p->to - p->from), -1., 1.);
    return *p;
  }
  static Ends ends_of(const Piece& p, const Along& T, const Along& dT) {
    return {p.r_form.dot(T), p.r_a.dot(T), p.r_form.dot(dT), p.r_a.dot(dT)};
  }
  Ends ends_at(double z) const {
    double x = 0;
    const Piece& p = piece_at(z, x);
    return ends_of(p, polynomials<Along>(x), 2 / (p.to - p.from) * slopes<Along>(x));
  }
  // Linear beyond both ends of the profile, and the same beyond the ends of the face.
  Place place(double u, double z) const {
    double x = 0;
    const Piece& p = piece_at(z, x);
    const Along T_z = polynomials<Along>(x), dT_z = 2 / (p.to - p.from) * slopes<Along>(x);
    const double within = std::clamp(u, 0., 1.), beyond = u - within;
    const Across T = polynomials<Across>(2 * within - 1), dT = 2 * slopes<Across>(2 * within - 1);
    const Across psi = p.psi * T_z, psi_z = p.psi * dT_z;
    const Ends ends = ends_of(p, T_z, dT_z);
    return {std::lerp(ends.r_form, ends.r_a, u),
            ends.r_a - ends.r_form,
            std::lerp(ends.r_form_z, ends.r_a_z, u),
            psi.dot(T) + beyond * psi.dot(dT),
            psi.dot(dT),
            psi_z.dot(T) + beyond * psi_z.dot(dT)};
  }

  std::vector<Piece> pieces_;
  double tip_;
};

}  // namespace

std::shared_ptr<const contact::ExactFlanks> hobbed_flanks(
    const gear::Toothing& toothing, const std::optional<gear::FlankDeviations>& deviations) {
  return std::make_shared<HobbedFlanks>(toothing, deviations);
}

}  // namespace elastogear::drive
