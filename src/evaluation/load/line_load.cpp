#include "evaluation/load/line_load.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "elastogear/base/error.h"

namespace elastogear::evaluation {
namespace {

constexpr int kEvenStations = 17;

// The width that each station stands for, m: the integral of its linear function.
Eigen::VectorXd widths(const Eigen::VectorXd& stations) {
  const Eigen::Index n = stations.size();
  Eigen::VectorXd width = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i + 1 < n; ++i) {
    const double half = (stations[i + 1] - stations[i]) / 2;
    width[i] += half;
    width[i + 1] += half;
  }
  return width;
}

Eigen::VectorXd even_stations(double width) {
  return Eigen::VectorXd::LinSpaced(kEvenStations, -width / 2, width / 2);
}

// Layers of the first gear seen from the second one, as far as both are in mesh.
Eigen::VectorXd moved_layers(const Gear& first, const Gear& second) {
  const Eigen::Vector3d axis = second.R.col(2), from_second = first.position[0] - second.position[0];
  const double sense = first.R.col(2).dot(axis) > 0 ? 1 : -1, shift = axis.dot(from_second);
  std::vector<double> z;
  for (double layer : first.layers)
    if (const double at = shift + sense * layer; std::abs(at) <= second.width / 2 * (1 + 1e-9))
      z.push_back(at);
  std::sort(z.begin(), z.end());
  return Eigen::Map<Eigen::VectorXd>(z.data(), static_cast<Eigen::Index>(z.size()));
}

}  // namespace

Eigen::VectorXd line_load(const Eigen::VectorXd& stations, const Eigen::VectorXd& z,
                          const Eigen::VectorXd& force) {
  const Eigen::Index n = stations.size();
  require(n >= 2, "line load: ", n, " stations over the face width, at least 2 are needed");
  Eigen::VectorXd load = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const auto after = std::upper_bound(stations.begin(), stations.end(), z[i]) - stations.begin();
    const Eigen::Index left = std::clamp<Eigen::Index>(after - 1, 0, n - 2);
    const double s = std::clamp((z[i] - stations[left]) / (stations[left + 1] - stations[left]), 0.0, 1.0);
    load[left] += (1 - s) * force[i];
    load[left + 1] += s * force[i];
  }
  return load.cwiseQuotient(widths(stations));
}

Eigen::VectorXd stations(const std::array<const Gear*, 2>& gear, int slave_side) {
  const bool parallel = transmission(*gear[0], *gear[1], 1).parallel;
  if (parallel && slave_side == 0 && gear[0]->layers.size() >= 2) {
    const Eigen::VectorXd moved = moved_layers(*gear[0], *gear[1]);
    if (moved.size() >= 2) return moved;
  }
  return gear[1]->layers.size() >= 2 ? gear[1]->layers : even_stations(gear[1]->width);
}

LineLoad line_load(const ContactHistory& contacts, const Eigen::VectorXd& stations) {
  LineLoad load{stations, Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(contacts.size()), stations.size())};
  for (std::size_t step = 0; step < contacts.size(); ++step) {
    const auto n = static_cast<Eigen::Index>(contacts[step].size());
    Eigen::VectorXd z(n), force(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const FlankContact& c = contacts[step][static_cast<std::size_t>(i)];
      z[i] = c.x_B[1][2];
      force[i] = c.normal_force;
    }
    load.value.row(static_cast<Eigen::Index>(step)) = line_load(stations, z, force);
  }
  return load;
}

Eigen::VectorXd mean_line_load(const LineLoad& load) {
  if (load.value.rows() == 0) return Eigen::VectorXd::Zero(load.z.size());
  return load.value.colwise().mean().transpose();
}

double face_load_factor(const LineLoad& load) {
  const Eigen::VectorXd mean = mean_line_load(load), width = widths(load.z);
  const double over_width = mean.dot(width) / width.sum();
  return over_width > 0 ? mean.maxCoeff() / over_width : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace elastogear::evaluation
