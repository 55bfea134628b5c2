#pragma once
// Properties that worm and wheel meshes share.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "elastogear/gear/design.h"
#include "elastogear/mesh/mesh.h"
#include "elastogear/mesh/quality.h"

namespace elastogear::gear {

/// The bounds on cell shape.
inline void expect_good_cells(const mesh::Mesh& mesh) {
  const mesh::Quality q = mesh::quality(mesh);
  EXPECT_GE(q.min_scaled_jacobian, 0.25) << "cell " << q.worst_cell;
  EXPECT_GT(q.min_jacobian, 0);
}

inline mesh::Face sorted(mesh::Face face) {
  std::sort(face.begin(), face.end());
  return face;
}

/// No face has more than two cells, no two nodes coincide, no node is unused, and the boundary is one closed
/// surface with the Euler characteristic 0 of a body with one through hole.
inline void expect_conforming(const mesh::Mesh& mesh) {
  mesh::validate(mesh, "mesh");
  std::map<mesh::Face, int> cells;
  for (int i = 0; i < mesh.cells.size(); ++i)
    for (const mesh::Face& face : mesh::cell_faces(mesh.cells.type[i], mesh.cells[i])) ++cells[sorted(face)];
  for (const auto& [face, count] : cells) ASSERT_LE(count, 2);

  std::set<int> nodes;
  std::map<std::pair<int, int>, int> edges;  // directed
  const auto boundary = mesh::boundary_faces(mesh);
  for (const mesh::Face& f : boundary)
    for (int i = 0; i < 4; ++i) {
      nodes.insert(f[i]);
      if (f[i] == f[(i + 1) % 4]) continue;  // of a triangle
      ++edges[{f[i], f[(i + 1) % 4]}];
    }
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, 1);
    ASSERT_TRUE(edges.contains({edge.second, edge.first}));
  }
  EXPECT_EQ(
      static_cast<int>(nodes.size()) - static_cast<int>(edges.size()) / 2 + static_cast<int>(boundary.size()),
      0);
}

/// No two nodes in the same box of two grids of boxes, the second shifted by half a box; every node has a
/// cell.
inline void expect_distinct_used_nodes(const mesh::Mesh& mesh) {
  constexpr double kBox = 1e-6;  // m, far below the smallest edge
  for (double shift : {0.0, 0.5}) {
    std::set<std::array<long, 3>> boxes;
    for (int i = 0; i < mesh.n_nodes(); ++i) {
      const Eigen::Vector3d x = mesh.X.col(i) / kBox + Eigen::Vector3d::Constant(shift);
      boxes.insert({std::lround(x[0]), std::lround(x[1]), std::lround(x[2])});
    }
    EXPECT_EQ(static_cast<int>(boxes.size()), mesh.n_nodes());
  }
  const std::set<int> used(mesh.cells.nodes.begin(), mesh.cells.nodes.end());
  EXPECT_EQ(static_cast<int>(used.size()), mesh.n_nodes());
}

/// Largest |flank_distance| of the nodes of one flank's faces, m.
inline double largest_distance(const mesh::Mesh& mesh, const std::string& set, const Toothing& t, int tooth,
                               int side) {
  double largest = 0;
  for (const mesh::Face& face : mesh::face_set(mesh, set))
    for (int node : face)
      largest = std::max(largest, std::abs(flank_distance(t, tooth, side, mesh.X.col(node))));
  return largest;
}

/// The flank's faces reach from the form radius to the tip, lie on the boundary and look out of the tooth.
inline void expect_flank(const mesh::Mesh& mesh, const std::string& set, const Toothing& t, int tooth,
                         int side) {
  constexpr double kExact = 1e-9;  // m, the bound
  EXPECT_LT(largest_distance(mesh, set, t, tooth, side), kExact) << set;
  double low = 1, high = 0;
  for (const mesh::Face& f : mesh::face_set(mesh, set)) {
    for (int node : f) {
      const double r = mesh.X.col(node).head<2>().norm();
      low = std::min(low, r), high = std::max(high, r);
    }
    const Eigen::Vector3d a = mesh.X.col(f[2]) - mesh.X.col(f[0]), b = mesh.X.col(f[3]) - mesh.X.col(f[1]);
    const Eigen::Vector3d n = a.cross(b).normalized();
    const Eigen::Vector3d centre = (mesh.X.col(f[0]) + mesh.X.col(f[2])) / 2;
    const double step =
        flank_distance(t, tooth, side, centre + 1e-6 * n) - flank_distance(t, tooth, side, centre);
    ASSERT_GT(step, 0.9e-6) << set;
  }
  EXPECT_NEAR(low, std::min(t.r_form, t.r_a), kExact) << set;
  EXPECT_NEAR(high, std::max(t.r_form, t.r_a), kExact) << set;
}

inline double volume(const mesh::Mesh& mesh) {
  double V = 0;
  for (int cell = 0; cell < mesh.cells.size(); ++cell) V += mesh::volume(mesh, cell);
  return V;
}

}  // namespace elastogear::gear
