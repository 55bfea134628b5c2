#include "dynamics/approach/patch_approach.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace elastogear::dynamics {

using Eigen::Index;
using Eigen::VectorXd;
using std::numbers::pi;

namespace {

// Forces at the middles of n equal stations, of length l, from the least t on: each goes to the two nearest.
VectorXd at_stations(const VectorXd& t, const VectorXd& p, Index n, double l) {
  VectorXd station = VectorXd::Zero(n);
  for (Index i = 0; i < t.size(); ++i) {
    const double place = std::clamp((t[i] - t.minCoeff()) / l - 0.5, 0.0, static_cast<double>(n - 1));
    const Index before = std::min(static_cast<Index>(place), std::max<Index>(n - 2, 0));
    const double share = n > 1 ? place - static_cast<double>(before) : 0;
    station[before] += (1 - share) * p[i];
    if (n > 1) station[before + 1] += share * p[i];
  }
  return station;
}

}  // namespace

PatchApproach line_approach(const VectorXd& t, const VectorXd& p, double curvature, double face,
                            double compliance) {
  constexpr double kWide = 4;  // half widths, which a station is at least long: it is a line from far away
  const double length = std::max(t.maxCoeff() - t.minCoeff(), face), F = p.sum();
  const double least = kWide * model::hertz_line(F / length, curvature, 1 / compliance).half_width;
  const auto n = std::max<Index>(1, std::lround(length / std::max(face, least)));
  const double l = length / static_cast<double>(n);
  const VectorXd S = at_stations(t, p, n, l);
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

PatchApproach patch_approach(const model::Curvatures& at, const VectorXd& t, const VectorXd& p, double face,
                             double compliance, double longest) {
  constexpr double kEllipse = 2. / 3;
  const double F = p.sum();
  if (at.least > 0) {
    const model::HertzEllipse ellipse = model::hertz_ellipse(at.least / 2, at.largest / 2, 1 / compliance);
    if (ellipse.k > model::kLeastAxes && ellipse.a(F) < longest / 2)
      return {ellipse.approach(F), kEllipse, false};
  }
  return line_approach(t, p, at.largest, face, compliance);
}

}  // namespace elastogear::dynamics
