#include "dynamics/approach/patch_approach.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace elastogear::dynamics {

using Eigen::Index;
using Eigen::VectorXd;
using std::numbers::pi;

VectorXd station_forces(const LineForces& forces, const LineExtent& line, Index n) {
  const double middle = (line.from + line.to) / 2, half = (line.to - line.from) / 2, F = forces.p.sum();
  const auto relative = [&](double t) { return std::clamp((t - middle) / half, -1.0, 1.0); };
  double first = 0, second = 0;  // moments on -1 <= s <= 1
  for (Index i = 0; i < forces.t.size(); ++i) {
    const double u = relative(forces.t[i] - line.face / 2), v = relative(forces.t[i] + line.face / 2);
    first += forces.p[i] / F * (u + v) / 2;
    second += forces.p[i] / F * (u * u + u * v + v * v) / 3;
  }
  VectorXd S(n);
  for (Index i = 0; i < n; ++i) {
    const double s = (2. * static_cast<double>(i) + 1) / static_cast<double>(n) - 1;
    S[i] = std::max(0.0, 1 + 3 * first * s + 5 * (3 * second - 1) / 2 * (3 * s * s - 1) / 2);
  }
  return S * (F / S.sum());
}

PatchApproach line_approach(const LineForces& forces, const LineExtent& extent, double least,
                            double curvature, double compliance) {
  constexpr double kWide = 4;  // half widths, which a station is at least long: it is a line from far away
  constexpr Index kMost = 16;  // stations
  const auto& [t, p] = forces;
  const double F = p.sum(), first = t[0], last = t[t.size() - 1];
  LineExtent line{std::clamp(extent.from, first - extent.face, first),
                  std::clamp(extent.to, last, last + extent.face), extent.face};
  const double short_of = std::max(0.0, least - (line.to - line.from));
  line.from -= short_of / 2;
  line.to += short_of / 2;
  const double length = line.to - line.from,
               wide = kWide * model::hertz_line(F / length, curvature, 1 / compliance).half_width;
  const Index n = std::clamp<Index>(std::lround(length / wide), 1, kMost);
  const double l = length / static_cast<double>(n);
  const VectorXd S = station_forces(forces, line, n);
  double sum = 0, own = 0;
  for (Index i = 0; i < n; ++i) {
    if (!(S[i] > 0)) continue;
    const double b = model::hertz_line(S[i] / l, curvature, 1 / compliance).half_width;
    sum += S[i] * S[i] / l * (2 * std::log(2 * l / b) + 1);
    own += S[i] * S[i] / l;
    for (Index j = 0; j < i; ++j) {
      const auto d = static_cast<double>(i - j);
      sum += 2 * S[i] * S[j] / l * std::log((d + 0.5) / (d - 0.5));
    }
  }
  return {compliance / pi * sum / F, 1 - own / sum};
}

bool is_ellipse(const model::Curvatures& at, double F, double compliance, double longest) {
  if (!(at.least > 0)) return false;
  const model::HertzEllipse ellipse = model::hertz_ellipse(at.least / 2, at.largest / 2, 1 / compliance);
  return ellipse.k > model::kLeastAxes && ellipse.a(F) < longest / 2;
}

PatchApproach ellipse_approach(const model::Curvatures& at, double F, double compliance) {
  constexpr double kEllipse = 2. / 3;
  return {model::hertz_ellipse(at.least / 2, at.largest / 2, 1 / compliance).approach(F), kEllipse, false};
}

}  // namespace elastogear::dynamics
