#pragma once
// Meshes that repeat around an axis, for tests.

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "elastogear/mesh/mesh.h"

namespace elastogear::test {

struct DiscCounts {
  int sectors, columns, rings, layers;  // columns: in one sector
};

/// A full disc of outer radius 1 m and thickness 0.4 m about z, with lobes and twisted so that it repeats in
/// no other way: wedges around the axis, hexahedra outside. Node set `bottom`, face set `surface`.
inline mesh::Mesh disc(const DiscCounts& n) {
  constexpr double kThickness = 0.4, kLobe = 0.1, kTwist = 0.3;
  const int around = n.sectors * n.columns, layer = 1 + n.rings * around;
  mesh::Mesh mesh;
  mesh.X.resize(3, layer * (n.layers + 1));
  const auto node = [&](int ring, int column, int k) {
    return ring == 0 ? layer * k : layer * k + 1 + (ring - 1) * around + column % around;
  };
  for (int k = 0; k <= n.layers; ++k) {
    const double z = kThickness * k / n.layers;
    mesh.X.col(node(0, 0, k)) << 0, 0, z;
    for (int ring = 1; ring <= n.rings; ++ring)
      for (int column = 0; column < around; ++column) {
        const double theta = 2 * M_PI * column / around + kTwist * z;
        const double r = (1 + kLobe * std::cos(n.sectors * theta)) * ring / n.rings;
        mesh.X.col(node(ring, column, k)) << r * std::cos(theta), r * std::sin(theta), z;
      }
  }
  for (int k = 0; k < n.layers; ++k)
    for (int j = 0; j < around; ++j) {
      const std::array wedge{node(0, j, k),     node(1, j, k),     node(1, j + 1, k),
                             node(0, j, k + 1), node(1, j, k + 1), node(1, j + 1, k + 1)};
      mesh.cells.add(mesh::CellType::wedge6, wedge);
      for (int i = 1; i < n.rings; ++i) {
        const std::array hex{
            node(i, j, k),     node(i + 1, j, k),     node(i + 1, j + 1, k),     node(i, j + 1, k),
            node(i, j, k + 1), node(i + 1, j, k + 1), node(i + 1, j + 1, k + 1), node(i, j + 1, k + 1)};
        mesh.cells.add(mesh::CellType::hex8, hex);
      }
    }
  for (int i = 0; i < layer; ++i) mesh.node_sets["bottom"].push_back(i);
  mesh.face_sets["surface"] = mesh::boundary_faces(mesh);
  return mesh;
}

/// The same mesh with nodes and cells in another order, and each cell's nodes as before. Cell sets and node
/// sets follow; face sets are dropped.
inline mesh::Mesh shuffled(const mesh::Mesh& mesh) {
  std::mt19937 random(5);
  std::vector<int> node(static_cast<std::size_t>(mesh.n_nodes())),
      cell(static_cast<std::size_t>(mesh.cells.size()));
  std::iota(node.begin(), node.end(), 0);
  std::iota(cell.begin(), cell.end(), 0);
  std::shuffle(node.begin(), node.end(), random);  // new number of each node
  std::shuffle(cell.begin(), cell.end(), random);  // old number of each cell
  mesh::Mesh result;
  result.X.resize(3, mesh.n_nodes());
  for (int i = 0; i < mesh.n_nodes(); ++i) result.X.col(node[i]) = mesh.X.col(i);
  std::vector<int> nodes, new_number(cell.size());
  for (int i = 0; i < mesh.cells.size(); ++i) {
    new_number[cell[i]] = i;
    nodes.clear();
    for (int a : mesh.cells[cell[i]]) nodes.push_back(node[a]);
    result.cells.add(mesh.cells.type[cell[i]], nodes);
  }
  const auto renumber = [](const auto& sets, const std::vector<int>& number, auto& renumbered) {
    for (const auto& [name, members] : sets) {
      for (int i : members) renumbered[name].push_back(number[i]);
      std::sort(renumbered[name].begin(), renumbered[name].end());
    }
  };
  renumber(mesh.node_sets, node, result.node_sets);
  renumber(mesh.cell_sets, new_number, result.cell_sets);
  return result;
}

}  // namespace elastogear::test
