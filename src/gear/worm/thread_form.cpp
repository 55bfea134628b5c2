#include "gear/worm/thread_form.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "elastogear/base/error.h"
#include "gear/worm/secant.h"

namespace elastogear::gear {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

constexpr int kChebyshev = 24;     // of the interpolation, exact to roundoff
constexpr int kToolSteps = 60;     // far more than it takes
constexpr double kOnTool = 1e-15;  // m
constexpr double kBeyond = 0.1;    // modules beyond tip and root where flanks are known, linear from there
constexpr double kCutter = 40;     // modules, diameter

// The flank of a space in the axial section: half the space's width at a radius, m.
struct AxialPoint {
  double r = 0, width = 0, slope = 0;
};

// A tool with straight flanks in the plane through the worm's radius and the normal of its helix, in the
// middle of the space. Its flank is half_width from the middle where it touches the pitch cylinder.
struct Tool {
  double r = 0, p = 0;                                 // m and m/rad, of the worm
  double tan_alpha = 0, sin_gamma = 0, cos_gamma = 0;  // -
  double axis = 0;                                     // m, from the worm's axis to the cutter's; 0: a line
};

// The line at the distance q from the worm's axis, screwed along the helix.
AxialPoint of_line(const Tool& tool, double half_width, double q) {
  const double eta = half_width + (q - tool.r) * tool.tan_alpha, y = -eta * tool.sin_gamma;
  const double r = std::hypot(q, y), dy = -tool.tan_alpha * tool.sin_gamma;
  const double dr = (q + y * dy) / r, dtheta = (q * dy - y) / (r * r);
  return {r, eta * tool.cos_gamma - tool.p * std::atan2(y, q),
          (tool.tan_alpha * tool.cos_gamma - tool.p * dtheta) / dr};
}

// The circle of the cone that reaches down to q: its point whose normal is at right angles to the velocity of
// the screw, (-y, x, p): Eq. (9.5).
AxialPoint of_cone(const Tool& tool, double half_width, double q) {
  const Vector3d along(0, tool.cos_gamma, tool.sin_gamma), across(0, -tool.sin_gamma, tool.cos_gamma);
  const double radius = tool.axis - q, eta = half_width + (q - tool.r) * tool.tan_alpha;
  double beta = 0;
  Vector3d x, n;
  for (int step = 0; step < kToolSteps; ++step) {
    const Vector3d out = -std::cos(beta) * Vector3d::UnitX() + std::sin(beta) * along;
    const Vector3d turn = std::sin(beta) * Vector3d::UnitX() + std::cos(beta) * along;
    x = tool.axis * Vector3d::UnitX() + radius * out + eta * across;
    n = across + tool.tan_alpha * out;
    const Vector3d v(-x[1], x[0], tool.p), dv(-radius * turn[1], radius * turn[0], 0);
    const double change = n.dot(v) / (tool.tan_alpha * turn.dot(v) + n.dot(dv));
    beta -= change;
    if (std::abs(change) * radius < kOnTool) break;
  }
  const double r = std::hypot(x[0], x[1]);
  return {r, x[2] - tool.p * std::atan2(x[1], x[0]), -(n[0] * x[0] + n[1] * x[1]) / r / n[2]};
}

AxialPoint of_tool(const Tool& tool, double half_width, double q) {
  return tool.axis > 0 ? of_cone(tool, half_width, q) : of_line(tool, half_width, q);
}

AxialPoint at_radius(const Tool& tool, double half_width, double r) {
  const double q = secant_zero([&](double at) { return of_tool(tool, half_width, at).r - r; }, r, 1, kOnTool);
  return of_tool(tool, half_width, q);
}

// Chebyshev polynomials over [from, to].
struct Interpolation {
  double from = 0, to = 0;
  std::array<double, kChebyshev> coefficient{};

  double operator()(double r) const {
    const double x = 2 * (r - from) / (to - from) - 1;
    double b_1 = 0, b_2 = 0;
    for (int k = kChebyshev - 1; k > 0; --k) {
      const double b = 2 * x * b_1 - b_2 + coefficient[k];
      b_2 = b_1, b_1 = b;
    }
    return x * b_1 - b_2 + coefficient[0];
  }
};

double node(double from, double to, int i) {
  return (from + to) / 2 + (to - from) / 2 * std::cos(pi * (i + 0.5) / kChebyshev);
}

Interpolation interpolation(double from, double to, const std::array<double, kChebyshev>& values) {
  Interpolation all{.from = from, .to = to};
  for (int k = 0; k < kChebyshev; ++k)
    for (int i = 0; i < kChebyshev; ++i)
      all.coefficient[k] +=
          (k == 0 ? 1.0 : 2.0) / kChebyshev * values[i] * std::cos(pi * k * (i + 0.5) / kChebyshev);
  return all;
}

const char* flank_form_name(FlankForm form) {
  constexpr const char* kNames[] = {"ZA", "ZN", "ZI", "ZK"};
  return kNames[static_cast<int>(form)];
}

void set_tool_flank(const Design& d, const Tool& tool, double s_x, Toothing& t) {
  const double half_space = pi * t.p / t.z - s_x / 2;
  const double half_width =
      secant_zero([&](double at) { return at_radius(tool, at, t.r).width - half_space; },
                  half_space * tool.cos_gamma, 1 / tool.cos_gamma, kOnTool);
  const double from = t.r_f, to = t.r + std::max(d.addendum, d.dedendum) + kBeyond * d.m_n;
  std::array<double, kChebyshev> thickness{}, slope{};
  for (int i = 0; i < kChebyshev; ++i) {
    const AxialPoint x = at_radius(tool, half_width, node(from, to, i));
    require(std::isfinite(x.slope) && x.slope > 0, "flank = ", flank_form_name(d.flank),
            ": its tool makes no flank at the radius ", node(from, to, i),
            " m; a smaller dedendum, a larger pressure_angle or fewer starts would do");
    thickness[i] = (pi * t.p / t.z - x.width) / t.p;
    slope[i] = -x.slope / t.p;
  }
  const Interpolation psi_of = interpolation(from, to, thickness), slope_of = interpolation(from, to, slope);
  t.half_angle = [=](double r, double) {
    const double at = std::clamp(r, from, to), d_r = slope_of(at);
    return HalfAngle{.psi = psi_of(at) + d_r * (r - at), .d_r = d_r};
  };
}

}  // namespace

// tan(alpha_t) = tan(alpha_n)/sin(angle).
Toothing pitch_toothing(const Design& d, int z, double angle, double s_n) {
  Toothing t{.z = z};
  t.r = d.m_n * z / (2 * std::sin(angle));
  t.r_a = t.r + d.addendum;
  t.r_f = t.r - d.dedendum;
  t.alpha_t = std::atan(std::tan(d.alpha_n) / std::sin(angle));
  t.r_b = t.r * std::cos(t.alpha_t);
  t.beta_b = std::asin(std::cos(angle) * std::cos(d.alpha_n));
  t.p = t.r * std::tan(angle);
  t.psi_b = s_n / (2 * t.r * std::sin(angle)) + involute(t.alpha_t);
  return t;
}

void thicken(Toothing& t, double s_x) {
  const double more = s_x / (2 * t.p);
  t.psi_b += more;
  if (!t.half_angle) return;
  t.half_angle = [thinner = t.half_angle, more](double r, double z) {
    HalfAngle half = thinner(r, z);
    half.psi += more;
    return half;
  };
}

double cutter_diameter(const Design& d) {
  return d.cutter_diameter > 0 ? d.cutter_diameter : kCutter * d.m_n;
}

void set_flank_form(const Design& d, double s_x, Toothing& t) {
  if (d.flank == FlankForm::ZI) return;
  t.r_b = t.beta_b = t.psi_b = 0;
  const double gamma = std::atan2(t.p, t.r), tan_alpha = std::tan(d.alpha_n);
  if (d.flank == FlankForm::ZA) {
    const double slope = -tan_alpha / std::cos(gamma) / t.p, psi_0 = s_x / 2 / t.p;
    t.half_angle = [=, r_0 = t.r](double r, double) {
      return HalfAngle{.psi = psi_0 + slope * (r - r_0), .d_r = slope};
    };
    return;
  }
  Tool tool{
      .r = t.r, .p = t.p, .tan_alpha = tan_alpha, .sin_gamma = std::sin(gamma), .cos_gamma = std::cos(gamma)};
  if (d.flank == FlankForm::ZK) tool.axis = t.r - d.dedendum + cutter_diameter(d) / 2;
  set_tool_flank(d, tool, s_x, t);
}

}  // namespace elastogear::gear
