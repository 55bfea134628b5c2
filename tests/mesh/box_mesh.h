#pragma once
// A box of hexahedra with sets of every kind, for the tests of mesh files and partitions.

#include <cmath>
#include <filesystem>

#include "elastogear/mesh/mesh.h"

namespace elastogear::mesh {

struct Counts {
  int x, y, z;
};

inline Mesh box_mesh(Counts n) {
  Mesh mesh;
  const auto node = [&](int i, int j, int k) { return i + (n.x + 1) * (j + (n.y + 1) * k); };
  mesh.X.resize(3, node(n.x, n.y, n.z) + 1);
  for (int k = 0; k <= n.z; ++k)
    for (int j = 0; j <= n.y; ++j)
      for (int i = 0; i <= n.x; ++i)
        mesh.X.col(node(i, j, k)) << std::sqrt(2.0) * i, 0.1 * j / 3, -1e-3 * std::exp(k);
  for (int k = 0; k < n.z; ++k)
    for (int j = 0; j < n.y; ++j)
      for (int i = 0; i < n.x; ++i)
        mesh.cells.add(CellType::hex8, std::array{node(i, j, k), node(i, j + 1, k), node(i + 1, j + 1, k),
                                                  node(i + 1, j, k), node(i, j, k + 1), node(i, j + 1, k + 1),
                                                  node(i + 1, j + 1, k + 1), node(i + 1, j, k + 1)});
  return mesh;
}

/// Sets that overlap, an empty set of each kind, faces out of order and in two sets.
inline Mesh box_mesh_with_sets(Counts n) {
  Mesh mesh = box_mesh(n);
  const int n_cells = mesh.cells.size();
  for (int i = 0; i < n_cells; ++i) {
    mesh.cell_sets["body"].push_back(i);
    if (i % 2 == 0) mesh.cell_sets["even"].push_back(i);
    if (i % 3 == 0) mesh.cell_sets["third"].push_back(i);
  }
  mesh.cell_sets["no_cell"];
  mesh.node_sets["seat"] = {0, 1, mesh.n_nodes() - 1};
  mesh.node_sets["root"] = {1, 2};
  mesh.node_sets["no_node"];
  const std::vector<Face> boundary = boundary_faces(mesh);
  mesh.face_sets["flank"] = boundary;
  mesh.face_sets["two"] = {boundary[3], boundary[1]};
  mesh.face_sets["no_face"];
  return mesh;
}

/// Bit for bit.
inline bool equal(const Mesh& a, const Mesh& b) {
  return a.X == b.X && a.cells.type == b.cells.type && a.cells.offset == b.cells.offset &&
         a.cells.nodes == b.cells.nodes && a.node_sets == b.node_sets && a.cell_sets == b.cell_sets &&
         a.face_sets == b.face_sets;
}

/// A folder of its own for one test, removed afterwards.
struct Folder {
  std::filesystem::path path;
  explicit Folder(const std::string& name)
      : path(std::filesystem::temp_directory_path() / ("elastogear_" + name + std::to_string(getpid()))) {
    std::filesystem::create_directories(path);
  }
  ~Folder() { std::filesystem::remove_all(path); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string operator/(const std::string& name) const { return (path / name).string(); }
  auto files() const {
    return std::distance(std::filesystem::directory_iterator(path), std::filesystem::directory_iterator());
  }
};

}  // namespace elastogear::mesh
