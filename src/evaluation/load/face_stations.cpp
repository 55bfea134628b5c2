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

Eigen::VectorXd stations(const std::array<const Gear*, 2>& gear, int slave_side, int along) {
  const Gear &here = *gear[static_cast<std::size_t>(along)],
             &there = *gear[static_cast<std::size_t>(1 - along)];
  const Eigen::VectorXd of_here = layers_or_even(here);
  if (!transmission(*gear[0], *gear[1], 1).parallel) return of_here;
  const Eigen::VectorXd of_there = seen_from(here, there, layers_or_even(there));
  const double begin = std::max(of_here[0], of_there[0]),
               end = std::min(of_here[of_here.size() - 1], of_there[of_there.size() - 1]);
  if (!(begin < end)) return of_here;
  return layers_between(slave_side == along ? of_here : of_there, begin, end);
}

StationShare share_out(const Eigen::VectorXd& stations, double z) {
  const Eigen::Index n = stations.size();
  require(n >= 2, "line load: ", n, " stations over the face width, at least 2 are needed");
  const auto after = std::upper_bound(stations.begin(), stations.end(), z) - stations.begin();
  const Eigen::Index left = std::clamp<Eigen::Index>(after - 1, 0, n - 2);
  const double s = std::clamp((z - stations[left]) / (stations[left + 1] - stations[left]), 0.0, 1.0);
  return {{left, left + 1}, {1 - s, s}};
}

Eigen::VectorXd ends_of_parts(const Eigen::VectorXd& stations) {
  const Eigen::Index n = stations.size();
  Eigen::VectorXd ends(n + 1);
  ends[0] = stations[0];
  for (Eigen::Index i = 1; i < n; ++i) ends[i] = (stations[i - 1] + stations[i]) / 2;
  ends[n] = stations[n - 1];
  return ends;
}

}  // namespace elastogear::evaluation
