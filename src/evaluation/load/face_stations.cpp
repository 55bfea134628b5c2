#include "elastogear/evaluation/face_stations.h"

#include <algorithm>
#include <vector>

#include "elastogear/base/error.h"

namespace elastogear::evaluation {
namespace {

constexpr int kEvenStations = 17;

Eigen::VectorXd layers_or_even(const Gear& gear) {
  if (gear.layers.size() >= 2) return gear.layers;
  return Eigen::VectorXd::LinSpaced(kEvenStations, -gear.width / 2, gear.width / 2);
}

// Places along the axis of one gear as they are along the parallel axis of another one.
Eigen::VectorXd seen_from(const Gear& other, const Gear& gear, const Eigen::VectorXd& z) {
  const Eigen::Vector3d axis = other.R.col(2);
  const double shift = axis.dot(gear.position[0] - other.position[0]);
  if (gear.R.col(2).dot(axis) > 0) return z.array() + shift;
  return shift - z.reverse().array();
}

// The layers between two places, and these. A layer next to an end counts where the end leaves at least half
// of the layer's distance to the one behind it.
Eigen::VectorXd layers_between(const Eigen::VectorXd& z, double begin, double end) {
  const Eigen::Index n = z.size();
  std::vector<double> within = {begin};
  for (Eigen::Index i = 0; i < n; ++i) {
    const double below = z[i] - z[std::max<Eigen::Index>(i - 1, 0)], above = z[std::min(i + 1, n - 1)] - z[i];
    if (z[i] > begin && z[i] < end && z[i] - begin >= below / 2 && end - z[i] >= above / 2)
      within.push_back(z[i]);
  }
  within.push_back(end);
  return Eigen::Map<Eigen::VectorXd>(within.data(), static_cast<Eigen::Index>(within.size()));
}

}  // namespace

FaceStations at_layers(const Eigen::VectorXd& z) {
  const Eigen::Index n = z.size();
  require(n >= 2, "line load: ", n, " stations over the face width, at least 2 are needed");
  FaceStations at{z, Eigen::VectorXd(n + 1)};
  at.ends[0] = z[0];
  for (Eigen::Index i = 1; i < n; ++i) at.ends[i] = (z[i - 1] + z[i]) / 2;
  at.ends[n] = z[n - 1];
  return at;
}

FaceStations at_strips(double begin, double end, int n) {
  const double half = (end - begin) / (2 * n);
  return {Eigen::VectorXd::LinSpaced(n, begin + half, end - half),
          Eigen::VectorXd::LinSpaced(n + 1, begin, end), true};
}

FaceStations stations(const std::array<const Gear*, 2>& gear, int slave_side, int strips, int along) {
  const Gear &here = *gear[static_cast<std::size_t>(along)],
             &there = *gear[static_cast<std::size_t>(1 - along)];
  const Eigen::VectorXd of_here = layers_or_even(here);
  const auto over = [&](double begin, double end, const Eigen::VectorXd& layers) {
    return strips > 0 ? at_strips(begin, end, strips) : at_layers(layers_between(layers, begin, end));
  };
  if (!transmission(*gear[0], *gear[1], 1).parallel)
    return strips > 0 && slave_side == along ? over(of_here[0], of_here[of_here.size() - 1], of_here)
                                             : at_layers(of_here);
  const Eigen::VectorXd of_there = seen_from(here, there, layers_or_even(there));
  const double begin = std::max(of_here[0], of_there[0]),
               end = std::min(of_here[of_here.size() - 1], of_there[of_there.size() - 1]);
  if (!(begin < end)) return at_layers(of_here);
  return over(begin, end, slave_side == along ? of_here : of_there);
}

StationShare share_out(const FaceStations& stations, double z) {
  const Eigen::VectorXd& limits = stations.of_parts ? stations.ends : stations.z;
  const Eigen::Index n = limits.size();
  const auto after = std::upper_bound(limits.begin(), limits.end(), z) - limits.begin();
  const Eigen::Index left = std::clamp<Eigen::Index>(after - 1, 0, n - 2);
  if (stations.of_parts) return {{left, left}, {1, 0}};
  const double s = std::clamp((z - limits[left]) / (limits[left + 1] - limits[left]), 0.0, 1.0);
  return {{left, left + 1}, {1 - s, s}};
}

}  // namespace elastogear::evaluation
