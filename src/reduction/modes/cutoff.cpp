#include "reduction/modes/cutoff.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

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
constexpr int kNewton = 20;             // iterations from above, where N(omega) is convex

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

// Coefficients of omega^3 and omega^2 in the number of modes of a large body.
struct WeylCoefficients {
  double volume = 0, surface = 0;
};

// Faces of the sector's cells at which the body ends, with their cells: where the sector is cut from the
// others the same orbits of nodes come twice.
std::vector<std::pair<mesh::Face, int>> outer_faces(const fem::Sector& sector) {
  std::vector<int> cell;
  const std::vector<mesh::Face> faces = mesh::boundary_faces(sector.mesh, &cell);
  std::map<std::vector<int>, std::vector<std::size_t>> of_orbits;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    std::vector<int> orbits;
    for (int node : faces[i]) orbits.push_back(sector.node_orbits.orbit[node]);
    std::sort(orbits.begin(), orbits.end());
    of_orbits[orbits].push_back(i);
  }
  std::vector<std::pair<mesh::Face, int>> outer;
  for (const auto& [orbits, which] : of_orbits)
    if (which.size() == 1 || orbits.front() < 0)
      for (std::size_t i : which) outer.emplace_back(faces[i], cell[i]);
  return outer;
}

double area(const mesh::Mesh& mesh, const mesh::Face& face) {
  const Eigen::Vector3d a = mesh.X.col(face[2]) - mesh.X.col(face[0]),
                        b = mesh.X.col(face[3]) - mesh.X.col(face[1]);
  return a.cross(b).norm() / 2;
}

WeylCoefficients weyl_coefficients(const fem::Sector& sector,
                                   const std::vector<model::MaterialRegion>& regions) {
  struct Speeds {
    double p2, s2;  // squares
  };
  const auto speeds = [&](int cell) {
    const model::Material& material = regions[sector.region[cell]].material;
    const auto [lambda, mu] = fem::mean_lame(material);
    return Speeds{(lambda + 2 * mu) / material.rho, mu / material.rho};
  };
  const auto share = [&](int cell) { return sector.turn.n_sectors * sector.weight[cell]; };
  WeylCoefficients result;
  for (int cell = 0; cell < sector.mesh.cells.size(); ++cell) {
    const auto [p2, s2] = speeds(cell);
    const double volume =
        fem::element_functions(sector.mesh.cells.type[cell]).volume(fem::cell_coordinates(sector.mesh, cell));
    result.volume += share(cell) * volume * (std::pow(p2, -1.5) + 2 * std::pow(s2, -1.5)) /
                     (6 * std::numbers::pi * std::numbers::pi);
  }
  for (const auto& [face, cell] : outer_faces(sector)) {
    const auto [p2, s2] = speeds(cell);
    result.surface += share(cell) * area(sector.mesh, face) * (2 * s2 * s2 - 3 * s2 * p2 + 3 * p2 * p2) /
                      (s2 * p2 * (p2 - s2)) / (16 * std::numbers::pi);
  }
  return result;
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

double weyl_cutoff(const fem::Sector& sector, const std::vector<model::MaterialRegion>& regions, double n) {
  const auto [volume, surface] = weyl_coefficients(sector, regions);
  double omega = std::min(std::cbrt(n / volume), std::sqrt(n / surface));  // above the root
  for (int i = 0; i < kNewton; ++i) {
    const double off = (volume * omega + surface) * omega * omega - n;
    omega -= off / ((3 * volume * omega + 2 * surface) * omega);
  }
  return omega * omega;
}

}  // namespace elastogear::reduction
