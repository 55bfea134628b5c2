// An elastic half-space below loads that are smooth to a mesh.

#include <array>
#include <cmath>

#include "contact/stations/smooth_load.h"

namespace elastogear::contact {
namespace {

// K of Eq. (6.46), with d^4 K / dx^2 dz^2 = 1/r, and its first and second integral over x.
struct Primitives {
  double K, K_1, K_2;

  Primitives operator-(const Primitives& o) const { return {K - o.K, K_1 - o.K_1, K_2 - o.K_2}; }
};

Primitives primitives(double x, double z) {
  const double sign = x < 0 ? -1 : 1;
  x = std::abs(x);
  z = std::abs(z);
  const double r = std::hypot(x, z), r_3 = r * r * r, x_2 = x * x, z_2 = z * z;
  const double A = z > 0 ? std::asinh(x / z) : 0, B = x > 0 ? std::asinh(z / x) : 0;  // times 0 there
  return {x_2 * z / 2 * B + x * z_2 / 2 * A - r_3 / 6,
          sign * (z * x * x_2 / 6 * B + (z_2 * x_2 / 4 - z_2 * z_2 / 48) * A - 5. / 48 * z_2 * x * r -
                  x * r_3 / 24),
          z * x_2 * x_2 / 24 * B + (z_2 * x * x_2 / 12 - z_2 * z_2 * x / 48) * A - 7. / 144 * z_2 * r_3 +
              z_2 * z_2 * r / 16 - r_3 * r * r / 120};
}

// Second differences between two strips, at the distance x across them: their mean over both, twice
// integrated over x.
Primitives between(double x, const Strip& a, const Strip& b) {
  const Primitives far = primitives(x, a.to - b.from) - primitives(x, a.to - b.to);
  const Primitives sum = far - (primitives(x, a.from - b.from) - primitives(x, a.from - b.to));
  const double area = a.length() * b.length();
  return {sum.K / area, sum.K_1 / area, sum.K_2 / area};
}

}  // namespace

// Loads that are linear between two ends have the derivative J_0 delta(x - from) + J_1 delta(x - to) + slope.
double smooth_inverse_distance(const AcrossLoad& across_a, const Strip& a, const AcrossLoad& across_b,
                               const Strip& b) {
  const std::array<double, 2> end_a{across_a.from, across_a.to}, end_b{across_b.from, across_b.to};
  const double slope_a = across_a.tilt / (across_a.to - across_a.from);
  const double slope_b = across_b.tilt / (across_b.to - across_b.from);
  double sum = 0;
  for (std::size_t p = 0; p < 2; ++p)
    for (std::size_t q = 0; q < 2; ++q) {
      const double sign_a = p == 0 ? 1 : -1, sign_b = q == 0 ? 1 : -1;
      const double jump_a = sign_a * across_a.density(end_a[p]), jump_b = sign_b * across_b.density(end_b[q]);
      const Primitives at = between(end_a[p] - end_b[q], a, b);
      sum += jump_a * jump_b * at.K + (jump_a * slope_b * sign_b - sign_a * slope_a * jump_b) * at.K_1 -
             sign_a * sign_b * slope_a * slope_b * at.K_2;
    }
  return -sum;
}

double point_kernel(const FlankGrid& flank, double v, double z, const LoadWidth& width,
                    const LineScale& scale) {
  const AcrossLoad across =
      across_load(v, width.a, flank.v.front(), flank.v.back()).seen_from(v, scale.across);
  const Strip face = point_strip(flank, z, width);
  const Strip along{face.from * scale.along, face.to * scale.along};
  return smooth_inverse_distance(across, along, across, along);
}

Eigen::MatrixXd smooth_kernel(const FlankGrid& flank, const std::vector<StationPlace>& stations,
                              const LoadWidth& width, const FreeEnds& ends, const LineScale& scale) {
  std::vector<AcrossLoad> across;
  std::vector<Strip> faces, along;
  for (const StationPlace& station : stations) {
    across.push_back(
        across_load(station.v, width.a, flank.v.front(), flank.v.back()).seen_from(station.v, scale.across));
    faces.push_back(station.face);
    along.push_back({station.face.from * scale.along, station.face.to * scale.along});
  }
  const FreeEnds along_ends{ends.lower * scale.along, ends.upper * scale.along, ends.share};
  const auto n = std::ssize(stations);
  Eigen::MatrixXd H(n, n);
  for (std::size_t i = 0; i < along.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = smooth_inverse_distance(across[i], along[i], across[j], along[j]);
      for (const Strip& image : images(along[j], along_ends))
        sum += ends.share * smooth_inverse_distance(across[i], along[i], across[j], image);
      H(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = sum;
      H(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(i)) = sum;
    }
  const Eigen::MatrixXd spread = spread_along(faces, width.c);
  return spread * H * spread.transpose();
}

}  // namespace elastogear::contact
