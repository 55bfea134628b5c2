#include "reduction/modes/cutoff.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "elastogear/fem/element.h"

namespace elastogear::reduction {
namespace {

constexpr double kWeyl = 2.0 / 3;       // sigma ~ N^(2/3), of waves in the volume
constexpr double kSurface = 1;          // sigma ~ N, of waves along surfaces
constexpr int kFewModes = 16;           // too few to show a power of their own
constexpr double kSpread = 3;           // factor by which that may differ from Weyl's
constexpr double kLargestStep = 8;      // factor of sigma between two counts
constexpr double kSmallestStep = 1.02;  // its least while sigma is known from one side only
constexpr double kLeastProgress = 0.1;  // of the logarithmic width of the bracket
constexpr double kNarrow = 1e-10;       // relative width of a bracket around equal eigenvalues

struct Point {
  double sigma;
  int n;
};

// sigma ~ N^exponent between two counts. Where these do not tell it is that of surfaces: what bodies with
// teeth have more modes than Weyl's law says lies there.
double exponent(const Point& a, const Point& b) {
  if (std::min(a.n, b.n) < kFewModes || a.n == b.n) return kSurface;
  return std::clamp(std::log(a.sigma / b.sigma) / std::log(a.n * 1.0 / b.n), kWeyl / kSpread,
                    kWeyl * kSpread);
}

// Next trial for the cutoff by the power law through both ends, or by that through the last two trials where
// only one end is known.
double next_guess(const Point& lower, const Point& upper, double power, double target) {
  const auto step = [&](double ratio) {
    return std::clamp(std::pow(ratio, power), kSmallestStep, kLargestStep);
  };
  if (!std::isfinite(upper.sigma)) return lower.sigma * step(target / std::max(1, lower.n));
  if (lower.sigma == 0) return upper.sigma / step(upper.n / target);
  const double fraction = lower.n == 0 ? 0.5 : std::log(target / lower.n) / std::log(upper.n * 1.0 / lower.n);
  return lower.sigma *
         std::pow(upper.sigma / lower.sigma, std::clamp(fraction, kLeastProgress, 1 - kLeastProgress));
}

}  // namespace

double find_cutoff(const Count& count, CountRange wanted, double start) {
  const double target = (wanted.least + wanted.most) / 2.0;
  Point lower{0, 0}, upper{std::numeric_limits<double>::infinity(), 0}, before{0, 0};
  for (double sigma = start, power = kSurface;; sigma = next_guess(lower, upper, power, target)) {
    const int n = count(sigma);
    if (n >= wanted.least && n <= wanted.most) return sigma;
    power = exponent({sigma, n}, before);
    before = {sigma, n};
    (n < wanted.least ? lower : upper) = before;
    if (upper.sigma - lower.sigma < kNarrow * upper.sigma) {
      count(upper.sigma);
      return upper.sigma;
    }
  }
}

double weyl_cutoff(const fem::Sector& sector, const std::vector<model::MaterialRegion>& regions, int n) {
  double density = 0;  // of modes: N = density omega^3 / (6 pi^2)
  for (int cell = 0; cell < sector.mesh.cells.size(); ++cell) {
    const model::Material& material = regions[sector.region[cell]].material;
    const auto [lambda, mu] = fem::mean_lame(material);
    const double c_p = std::sqrt((lambda + 2 * mu) / material.rho), c_s = std::sqrt(mu / material.rho);
    const double volume =
        fem::element_functions(sector.mesh.cells.type[cell]).volume(fem::cell_coordinates(sector.mesh, cell));
    density +=
        sector.turn.n_sectors * sector.weight[cell] * volume * (std::pow(c_p, -3) + 2 * std::pow(c_s, -3));
  }
  return std::pow(6 * std::numbers::pi * std::numbers::pi * n / density, kWeyl);
}

}  // namespace elastogear::reduction
