#pragma once
// Structured flanks with uneven rows and layers.

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "contact/stations/smooth_load.h"

namespace elastogear::contact {

/// Numbers the nodes of faces with 4 or 8 nodes, those of the corners first.
inline FlankGrid numbered_flank(std::vector<double> v, std::vector<double> z, bool second_order) {
  FlankGrid flank{std::move(v), {}, std::move(z)};
  const int rows = flank.n_rows(), layers = flank.n_layers();
  const auto corner = [&](int i, int j) { return i * (layers + 1) + j; };
  const int n_corners = (rows + 1) * (layers + 1), n_along_v = rows * (layers + 1);
  const auto along_v = [&](int i, int j) { return n_corners + i * (layers + 1) + j; };
  const auto along_z = [&](int i, int j) { return n_corners + n_along_v + i * layers + j; };
  flank.n_nodes = second_order ? n_corners + n_along_v + (rows + 1) * layers : n_corners;
  for (int i = 0; i < rows; ++i) {
    const double low = flank.v[static_cast<std::size_t>(i)], high = flank.v[static_cast<std::size_t>(i) + 1];
    if (second_order) flank.v_mid.push_back((low + high) / 2 + 0.04 * (high - low));
    for (int j = 0; j < layers; ++j) {
      FlankGrid::Face face{corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)};
      if (second_order) {
        face[4] = along_v(i, j);
        face[5] = along_z(i + 1, j);
        face[6] = along_v(i, j + 1);
        face[7] = along_z(i, j);
      }
      flank.face.push_back(face);
    }
  }
  return flank;
}

/// n_nodes: a function of (v, z) at the nodes.
template <class Function>
Eigen::VectorXd at_nodes(const FlankGrid& flank, const Function& g) {
  Eigen::VectorXd value(flank.n_nodes);
  for (int i = 0; i < flank.n_rows(); ++i)
    for (int j = 0; j < flank.n_layers(); ++j) {
      const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
      const FlankGrid::Face& node = flank.face[a * static_cast<std::size_t>(flank.n_layers()) + b];
      const double v_0 = flank.v[a], v_1 = flank.v[a + 1], z_0 = flank.z[b], z_1 = flank.z[b + 1];
      value[node[0]] = g(v_0, z_0);
      value[node[1]] = g(v_1, z_0);
      value[node[2]] = g(v_1, z_1);
      value[node[3]] = g(v_0, z_1);
      if (flank.v_mid.empty()) continue;
      value[node[4]] = g(flank.v_mid[a], z_0);
      value[node[5]] = g(v_1, (z_0 + z_1) / 2);
      value[node[6]] = g(flank.v_mid[a], z_1);
      value[node[7]] = g(v_0, (z_0 + z_1) / 2);
    }
  return value;
}

/// The same faces in no rows and layers; those of 4 nodes each as two triangles where wanted.
inline FlankGrid in_patches(const FlankGrid& flank, bool in_triangles) {
  FlankGrid patches{{flank.v.front(), flank.v.back()}, {}, {flank.z.front(), flank.z.back()}};
  patches.n_nodes = flank.n_nodes;
  const auto n = static_cast<std::size_t>(flank.n_layers());
  for (std::size_t f = 0; f < flank.face.size(); ++f) {
    const double v_0 = flank.v[f / n], v_1 = flank.v[f / n + 1], z_0 = flank.z[f % n],
                 z_1 = flank.z[f % n + 1];
    const FlankGrid::Face& node = flank.face[f];
    Eigen::Matrix<double, 2, 4> at;
    at << v_0, v_1, v_1, v_0, z_0, z_0, z_1, z_1;
    if (!in_triangles) {
      patches.patch.push_back({{node.begin(), node.begin() + (flank.v_mid.empty() ? 4 : 8)}, at});
      continue;
    }
    patches.patch.push_back({{node[0], node[1], node[2]}, at(Eigen::all, {0, 1, 2, 2})});
    patches.patch.push_back({{node[0], node[2], node[3]}, at(Eigen::all, {0, 2, 3, 3})});
  }
  return patches;
}

/// n even strips from z_0 to z_1, on a line of contact that crosses z = 0 at v.
inline std::vector<StationPlace> even_stations(int n, double z_0, double z_1, double v, double slope = 0) {
  std::vector<StationPlace> stations;
  for (int i = 0; i < n; ++i) {
    const Strip face{z_0 + (z_1 - z_0) * i / n, z_0 + (z_1 - z_0) * (i + 1) / n};
    stations.push_back({face, v + slope * face.centre(), slope});
  }
  return stations;
}

}  // namespace elastogear::contact
