#pragma once
// Meshes of other cell types, made from meshes of 8-node hexahedra.

#include <map>
#include <numeric>

#include "brick.h"

namespace elastogear::test {

using Piece = std::vector<int>;

inline void add(mesh::Mesh& mesh, mesh::CellType type, std::span<const int> hex,
                const std::vector<Piece>& pieces) {
  for (Piece piece : pieces) {
    for (int& node : piece) node = hex[node];
    mesh.cells.add(type, piece);
  }
}

/// Two wedges, split by the plane through the corners 0, 2, 6, 4.
inline void add_wedges(mesh::Mesh& mesh, std::span<const int> hex) {
  add(mesh, mesh::CellType::wedge6, hex, {{0, 1, 2, 4, 5, 6}, {0, 2, 3, 4, 6, 7}});
}

/// Kuhn's six tetrahedra around the diagonal 0-6.
inline void add_tetrahedra(mesh::Mesh& mesh, std::span<const int> hex) {
  add(mesh, mesh::CellType::tet4, hex,
      {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6}, {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}});
}

inline int add_centre(mesh::Mesh& mesh, std::span<const int> hex) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (int node : hex) centre += mesh.X.col(node) / 8;
  mesh.X.conservativeResize(3, mesh.n_nodes() + 1);
  mesh.X.rightCols<1>() = centre;
  return mesh.n_nodes() - 1;
}

/// Six pyramids with their apices at the centre; the one at the bottom is cut into two tetrahedra along 0-2
/// if so wanted, so that it meets a wedge below.
inline void add_pyramids(mesh::Mesh& mesh, std::span<const int> hex, bool cut_bottom = false) {
  const int apex = add_centre(mesh, hex);
  for (const mesh::Face& f : mesh::cell_faces(mesh::CellType::hex8, hex)) {
    const bool bottom = f == mesh::Face{hex[0], hex[3], hex[2], hex[1]};
    if (bottom && cut_bottom) {
      mesh.cells.add(mesh::CellType::tet4, Piece{hex[0], hex[1], hex[2], apex});
      mesh.cells.add(mesh::CellType::tet4, Piece{hex[0], hex[2], hex[3], apex});
    } else {
      mesh.cells.add(mesh::CellType::pyramid5, Piece{f[3], f[2], f[1], f[0], apex});
    }
  }
}

/// Makes a new mesh by what `add` does with each hexahedron (its nodes and its number). Node sets stay, the
/// face set `surface` is found anew.
template <class Add>
mesh::Mesh rebuilt(const mesh::Mesh& hexahedra, const Add& add) {
  mesh::Mesh result;
  result.X = hexahedra.X;
  result.node_sets = hexahedra.node_sets;
  for (int i = 0; i < hexahedra.cells.size(); ++i) add(result, hexahedra.cells[i], i);
  result.face_sets["surface"] = mesh::boundary_faces(result);
  return result;
}

/// The second-order mesh with straight edges. A midside node is in a node set when both its corners are.
inline mesh::Mesh second_order(const mesh::Mesh& linear) {
  static const std::map<mesh::CellType, mesh::CellType> type = {
      {mesh::CellType::hex8, mesh::CellType::hex20},
      {mesh::CellType::tet4, mesh::CellType::tet10},
      {mesh::CellType::wedge6, mesh::CellType::wedge15}};
  mesh::Mesh result;
  std::map<std::pair<int, int>, int> midside;
  std::vector<Eigen::Vector3d> X;
  for (int cell = 0; cell < linear.cells.size(); ++cell) {
    std::vector<int> nodes(linear.cells[cell].begin(), linear.cells[cell].end());
    for (const auto& [a, b] : mesh::edges(linear.cells.type[cell])) {
      const auto [first, second] = std::minmax(nodes[a], nodes[b]);
      const int next = linear.n_nodes() + static_cast<int>(X.size());
      const auto [at, fresh] = midside.try_emplace({first, second}, next);
      if (fresh) X.push_back((linear.X.col(first) + linear.X.col(second)) / 2);
      nodes.push_back(at->second);
    }
    result.cells.add(type.at(linear.cells.type[cell]), nodes);
  }
  result.X.resize(3, linear.n_nodes() + static_cast<Eigen::Index>(X.size()));
  result.X.leftCols(linear.n_nodes()) = linear.X;
  for (std::size_t i = 0; i < X.size(); ++i)
    result.X.col(linear.n_nodes() + static_cast<Eigen::Index>(i)) = X[i];
  result.node_sets = linear.node_sets;
  for (auto& set : result.node_sets) {
    auto& nodes = set.second;
    const auto has = [&](int node) { return std::binary_search(nodes.begin(), nodes.end(), node); };
    std::vector<int> added;
    for (const auto& [corners, node] : midside)
      if (has(corners.first) && has(corners.second)) added.push_back(node);
    nodes.insert(nodes.end(), added.begin(), added.end());
    std::sort(nodes.begin(), nodes.end());
  }
  result.face_sets["surface"] = mesh::boundary_faces(result);
  return result;
}

/// A brick's hexahedra as cells of one type.
inline mesh::Mesh cells_of(mesh::CellType type, const mesh::Mesh& hexahedra) {
  using mesh::CellType;
  switch (type) {
    case CellType::hex8:
      return hexahedra;
    case CellType::tet4:
      return rebuilt(hexahedra, [](auto& mesh, auto hex, int) { add_tetrahedra(mesh, hex); });
    case CellType::wedge6:
      return rebuilt(hexahedra, [](auto& mesh, auto hex, int) { add_wedges(mesh, hex); });
    case CellType::pyramid5:
      return rebuilt(hexahedra, [](auto& mesh, auto hex, int) { add_pyramids(mesh, hex); });
    case CellType::hex20:
      return second_order(hexahedra);
    case CellType::tet10:
      return second_order(cells_of(CellType::tet4, hexahedra));
    case CellType::wedge15:
      return second_order(cells_of(CellType::wedge6, hexahedra));
  }
  return {};
}

/// A brick of n x n x n hexahedra in which columns of pyramids, of hexahedra, and of wedges below pyramids
/// and tetrahedra alternate.
inline mesh::Mesh mixed(const mesh::Mesh& hexahedra, int n) {
  return rebuilt(hexahedra, [n](mesh::Mesh& mesh, std::span<const int> hex, int i) {
    const int column = (i % n + i / n % n) % 3, layer = i / (n * n);
    if (column == 0) return add_pyramids(mesh, hex);
    if (column == 1) return mesh.cells.add(mesh::CellType::hex8, hex);
    if (layer + 1 < n) return add_wedges(mesh, hex);
    add_pyramids(mesh, hex, true);
  });
}

/// Columns of hexahedra and of wedges alternate.
inline mesh::Mesh hexahedra_and_wedges(const mesh::Mesh& hexahedra, int n) {
  return rebuilt(hexahedra, [n](mesh::Mesh& mesh, std::span<const int> hex, int i) {
    if ((i % n + i / n % n) % 2 == 0) return mesh.cells.add(mesh::CellType::hex8, hex);
    add_wedges(mesh, hex);
  });
}

inline std::vector<mesh::CellType> all_cell_types() {
  std::vector<mesh::CellType> types;
  for (int i = 0; i < mesh::kCellTypes; ++i) types.push_back(static_cast<mesh::CellType>(i));
  return types;
}

}  // namespace elastogear::test
