// Consistent nodal forces of smooth loads on the faces of a flank.

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "contact/stations/smooth_load.h"
#include "elastogear/base/error.h"
#include "elastogear/contact/face.h"
#include "elastogear/model/side_shape.h"

namespace elastogear::contact {
namespace {

struct GaussPoint {
  double at, weight;  // on [-1, 1]
};
const std::array<GaussPoint, 3> kGauss{{{-std::sqrt(0.6), 5. / 9}, {0, 8. / 9}, {std::sqrt(0.6), 5. / 9}}};

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
      const model::SideShape N = model::side_shape(flank.v_mid.empty() ? 4 : 8, x, y);
      for (Eigen::Index i = 0; i < N.size(); ++i) weight[node[static_cast<std::size_t>(i)]] += share * N[i];
    }
  }
}

// m, the largest sizes of patches across the profile and along the face.
Eigen::Vector2d patch_size(const FlankGrid& flank) {
  Eigen::Vector2d size = Eigen::Vector2d::Zero();
  for (const FlankPatch& patch : flank.patch)
    size = size.cwiseMax(patch.at.rowwise().maxCoeff() - patch.at.rowwise().minCoeff());
  return size;
}

// Adds a force at a place, on the patch that it is on or nearest to.
void add_at(const FlankGrid& flank, const Eigen::Vector2d& place, double force,
            Eigen::Ref<Eigen::RowVectorXd> weight) {
  const FlankPatch* on = nullptr;
  PlaceOnSide best{0, {0, 0}, std::numeric_limits<double>::infinity()};
  for (const FlankPatch& patch : flank.patch) {
    const Eigen::Vector2d low = patch.at.rowwise().minCoeff(), high = patch.at.rowwise().maxCoeff();
    const double off = ((low - place).cwiseMax(place - high).array() / (high - low).array()).maxCoeff();
    if (off >= best.beyond) continue;
    const PlaceOnSide here = place_on_side(patch.at, place);
    if (here.beyond >= best.beyond) continue;
    best = here;
    on = &patch;
    if (best.beyond <= 0) break;
  }
  if (best.corners == 4) {
    best.at = best.at.cwiseMax(-1.).cwiseMin(1.);
  } else {
    best.at = best.at.cwiseMax(0.);
    best.at /= std::max(1., best.at.sum());
  }
  const auto n = static_cast<int>(on->node.size());
  const model::SideShape N = model::side_shape(n, best.at[0], best.at[1]);
  for (int i = 0; i < n; ++i) weight[on->node[static_cast<std::size_t>(i)]] += force * N[i];
}

// The integrals by Gauss's rule over pieces smaller than patches, whose edges they do not follow.
Eigen::RowVectorXd patch_weights(const FlankGrid& flank, const StationPlace& station, double a) {
  constexpr double kPiece = 0.125;  // of the largest patch
  const Eigen::Vector2d piece = kPiece * patch_size(flank);
  Eigen::RowVectorXd weight = Eigen::RowVectorXd::Zero(flank.n_nodes);
  const auto visit = [](double from, double to, double most, const auto& use) {
    const int n = static_cast<int>(std::ceil((to - from) / most));
    for (int i = 0; i < n; ++i)
      for (const GaussPoint& point : kGauss)
        use(from + (to - from) * (i + (1 + point.at) / 2) / n, point.weight / 2 * (to - from) / n);
  };
  visit(station.face.from, station.face.to, piece[1], [&](double z, double dz) {
    const double v = station.v + station.slope * (z - station.face.centre());
    const AcrossLoad load = across_load(v, a, flank.v.front(), flank.v.back());
    visit(load.from, load.to, piece[0], [&](double at, double dv) {
      add_at(flank, {at, z}, dz / station.face.length() * dv * load.density(at), weight);
    });
  });
  return weight;
}

// Nodal forces of 1 N, even over the strip.
Eigen::RowVectorXd strip_weights(const FlankGrid& flank, const StationPlace& station, double a) {
  if (!flank.patch.empty()) return patch_weights(flank, station, a);
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

PlaceOnSide place_on_side(const Eigen::Matrix<double, 2, 4>& corner, const Eigen::Vector2d& place) {
  constexpr int kSteps = 3;  // sides are nearly parallelograms
  PlaceOnSide on{corner.col(2) == corner.col(3) ? 3 : 4, {0, 0}, 0};
  for (int step = 0; step < kSteps; ++step) {
    const Shape s = shape(on.corners, on.at[0], on.at[1]);
    Eigen::Matrix2d J;
    J << corner * s.N_u, corner * s.N_v;
    on.at -= J.inverse() * (corner * s.N - place);
  }
  if (on.corners == 4)
    on.beyond = on.at.cwiseAbs().maxCoeff() - 1;
  else
    on.beyond = 2 * std::max({-on.at[0], -on.at[1], on.at.sum() - 1});
  return on;
}

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
