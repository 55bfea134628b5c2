#pragma once
// Structured bricks of hexahedra for tests.

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <functional>
#include <random>

#include "elastogear/mesh/mesh.h"
#include "elastogear/model/material.h"

namespace elastogear::test {

using Map = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

/// n[0] x n[1] x n[2] cells on [0, length]; node sets xmin .. zmax, face set surface (all) and the same six.
inline mesh::Mesh brick(const std::array<int, 3>& n, const Eigen::Vector3d& length) {
  mesh::Mesh mesh;
  const auto number = [&](int i, int j, int k) { return i + (n[0] + 1) * (j + (n[1] + 1) * k); };
  mesh.X.resize(3, number(n[0], n[1], n[2]) + 1);
  for (int k = 0; k <= n[2]; ++k)
    for (int j = 0; j <= n[1]; ++j)
      for (int i = 0; i <= n[0]; ++i)
        mesh.X.col(number(i, j, k)) << i * length.x() / n[0], j * length.y() / n[1], k * length.z() / n[2];
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) {
        const std::array<int, 8> nodes = {number(i, j, k),
                                          number(i + 1, j, k),
                                          number(i + 1, j + 1, k),
                                          number(i, j + 1, k),
                                          number(i, j, k + 1),
                                          number(i + 1, j, k + 1),
                                          number(i + 1, j + 1, k + 1),
                                          number(i, j + 1, k + 1)};
        mesh.cells.add(mesh::CellType::hex8, nodes);
      }
  const char* const names[3][2] = {{"xmin", "xmax"}, {"ymin", "ymax"}, {"zmin", "zmax"}};
  for (int side = 0; side < 6; ++side) {
    const int axis = side / 2;
    const double plane = side % 2 ? length(axis) : 0;
    const auto at_plane = [&](int node) {
      return std::abs(mesh.X(axis, node) - plane) < 1e-9 * length(axis);
    };
    for (int node = 0; node < mesh.n_nodes(); ++node)
      if (at_plane(node)) mesh.node_sets[names[axis][side % 2]].push_back(node);
    for (const mesh::Face& face : mesh::boundary_faces(mesh))
      if (std::all_of(face.begin(), face.end(), at_plane))
        mesh.face_sets[names[axis][side % 2]].push_back(face);
  }
  mesh.face_sets["surface"] = mesh::boundary_faces(mesh);
  return mesh;
}

/// Moves every node by `map`.
inline mesh::Mesh mapped(mesh::Mesh mesh, const Map& map) {
  for (int i = 0; i < mesh.n_nodes(); ++i) mesh.X.col(i) = map(mesh.X.col(i));
  return mesh;
}

/// Moves inner nodes (those in no face of the boundary) by up to `amount` in each direction, reproducibly.
inline mesh::Mesh distorted(mesh::Mesh mesh, double amount) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> shift(-amount, amount);
  std::vector<bool> outer(static_cast<std::size_t>(mesh.n_nodes()), false);
  for (const mesh::Face& face : mesh::boundary_faces(mesh))
    for (int node : face) outer[node] = true;
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    const Eigen::Vector3d d(shift(random), shift(random), shift(random));
    if (!outer[i]) mesh.X.col(i) += d;
  }
  return mesh;
}

inline const model::Material kSteel{210e9, 0.3, 7850};
/// Glass fibre in epoxy, its axes askew.
inline const model::Material kFibre{
    0, 0, 1900,
    model::Orthotropic{{45e9, 12e9, 10e9},
                       {0.28, 0.25, 0.4},
                       {5.5e9, 4.5e9, 3.5e9},
                       {.axis_1 = {1, 0.5, 0.2}, .axis_2 = {-0.3, 1, 0.4}, .rotation = {0.2, 0, 0}}}};
inline const std::vector<model::MaterialRegion> kSteelBody{{"", kSteel}};

}  // namespace elastogear::test
