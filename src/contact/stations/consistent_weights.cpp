// Consistent nodal forces of smooth loads on the faces of a flank.

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "contact/stations/smooth_load.h"
#include "elastogear/base/error.h"

namespace elastogear::contact {
namespace {

struct GaussPoint {
  double at, weight;  // on [-1, 1]
};
const std::array<GaussPoint, 3> kGauss{{{-std::sqrt(0.6), 5. / 9}, {0, 8. / 9}, {std::sqrt(0.6), 5. / 9}}};

// Shape functions of a face at its coordinates from -1 to 1 along v and z.
std::array<double, 8> face_shape(double x, double y, bool second_order) {
  std::array<double, 8> N{(1 - x) * (1 - y) / 4, (1 + x) * (1 - y) / 4, (1 + x) * (1 + y) / 4,
                          (1 - x) * (1 + y) / 4};
  if (!second_order) return N;
  const std::array<double, 4> middle{(1 - x * x) * (1 - y) / 2, (1 + x) * (1 - y * y) / 2,
                                     (1 - x * x) * (1 + y) / 2, (1 - x) * (1 - y * y) / 2};
  for (std::size_t i = 0; i < 4; ++i) {
    N[i] -= (middle[i] + middle[(i + 3) % 4]) / 2;
    N[4 + i] = middle[i];
  }
  return N;
}

// v over a row as its nodes have it: middle + rise x + bend x^2, x from -1 to 1.
struct RowMap {
  double middle, rise, bend;

  RowMap(const FlankGrid& flank, std::size_t row) {
    const double low = flank.v[row], high = flank.v[row + 1];
    middle = flank.v_mid.empty() ? (low + high) / 2 : flank.v_mid[row];
    rise = (high - low) / 2;
    bend = (low + high) / 2 - middle;
  }
  double v(double x) const { return middle + x * (rise + bend * x); }
  double slope(double x) const { return rise + 2 * bend * x; }
  double x(double at) const {  // within the row
    const double up = at - middle, root = std::sqrt(std::max(0., rise * rise + 4 * bend * up));
    return std::clamp(2 * up / (rise + root), -1., 1.);
  }
};

// Adds the nodal forces of a load across the profile, at the coordinate y of a layer. Exact: the products of
// shape function, density and slope of v are polynomials of degree 5.
void add_across(const FlankGrid& flank, const AcrossLoad& load, std::size_t layer, double y, double force,
                Eigen::Ref<Eigen::RowVectorXd> weight) {
  const auto n_layers = static_cast<std::size_t>(flank.n_layers());
  for (std::size_t row = 0; row < static_cast<std::size_t>(flank.n_rows()); ++row) {
    const double from = std::max(load.from, flank.v[row]), to = std::min(load.to, flank.v[row + 1]);
    if (from >= to) continue;
    const RowMap map(flank, row);
    const double x_0 = map.x(from), x_1 = map.x(to);
    const FlankGrid::Face& node = flank.face[row * n_layers + layer];
    for (const GaussPoint& point : kGauss) {
      const double x = (x_0 + x_1) / 2 + point.at * (x_1 - x_0) / 2;
      const double share = force * point.weight * (x_1 - x_0) / 2 * map.slope(x) * load.density(map.v(x));
      const auto N = face_shape(x, y, !flank.v_mid.empty());
      for (std::size_t i = 0; i < (flank.v_mid.empty() ? 4U : 8U); ++i) weight[node[i]] += share * N[i];
    }
  }
}

// Nodal forces of 1 N, even over the strip.
Eigen::RowVectorXd strip_weights(const FlankGrid& flank, const StationPlace& station, double a) {
  Eigen::RowVectorXd weight = Eigen::RowVectorXd::Zero(flank.n_nodes);
  for (std::size_t layer = 0; layer < static_cast<std::size_t>(flank.n_layers()); ++layer) {
    const double low = flank.z[layer], high = flank.z[layer + 1];
    const double from = std::max(station.face.from, low), to = std::min(station.face.to, high);
    if (from >= to) continue;
    for (const GaussPoint& point : kGauss) {
      const double z = (from + to) / 2 + point.at * (to - from) / 2;
      const double v = station.v + station.slope * (z - station.face.centre());
      add_across(flank, across_load(v, a, flank.v.front(), flank.v.back()), layer,
                 (2 * z - low - high) / (high - low), point.weight / 2 * (to - from) / station.face.length(),
                 weight);
    }
  }
  return weight;
}

void require_on_flank(const FlankGrid& flank, const StationPlace& station) {
  const double margin = 1e-9 * station.face.length();
  require(station.face.from < station.face.to && station.face.from >= flank.z.front() - margin &&
              station.face.to <= flank.z.back() + margin,
          "a station reaches from z = ", station.face.from, " m to ", station.face.to,
          " m, must be within the face, from ", flank.z.front(), " m to ", flank.z.back(), " m");
}

}  // namespace

Eigen::MatrixXd consistent_weights(const FlankGrid& flank, const std::vector<StationPlace>& stations,
                                   const LoadWidth& width) {
  Eigen::MatrixXd weight(std::ssize(stations), flank.n_nodes);
  std::vector<Strip> strips;
  for (const StationPlace& station : stations) {
    require_on_flank(flank, station);
    weight.row(std::ssize(strips)) = strip_weights(flank, station, width.a);
    strips.push_back(station.face);
  }
  return spread_along(strips, width.c) * weight;
}

Eigen::RowVectorXd point_weights(const FlankGrid& flank, double v, double z, double slope,
                                 const LoadWidth& width) {
  const Strip face = point_strip(flank, z, width);
  return strip_weights(flank, {face, v + slope * (face.centre() - z), slope}, width.a);
}

}  // namespace elastogear::contact
