#pragma once
// Topology of a surface: the faces that meet at its edges and nodes, its boundary, normals, and shares of
// area.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "elastogear/contact/face.h"

namespace elastogear::contact {

/// Lists in compressed rows.
struct Rows {
  std::vector<int> offset, value;

  std::span<const int> operator[](int i) const {
    return {value.data() + offset[i], static_cast<std::size_t>(offset[i + 1] - offset[i])};
  }
  int size() const { return static_cast<int>(offset.size()) - 1; }
};

/// Face numbers ascend in each list.
struct Topology {
  Eigen::Matrix4Xi
      edge;           ///< 4 x n_f, edge of side i; -1 for the missing side of a triangle or one of no length
  Rows edge_sides;    ///< per edge: 4 face + side
  Rows node_corners;  ///< per node: 4 face + corner
  std::vector<int> open_faces;  ///< faces with an edge that no other face has

  bool is_open(int face, int side) const {
    return edge(side, face) >= 0 && edge_sides[edge(side, face)].size() == 1;
  }
};

int side_count(const Eigen::Matrix4Xi& face, int f);

/// face: 4 x n_f node numbers in 0 .. n_nodes-1.
Topology topology(const Eigen::Matrix4Xi& face, int n_nodes);

/// Finds the positions of nodes where they are asked for.
class NodePlacer {
 public:
  /// Sets the position of a node of one of two surfaces (side 0 or 1), m, and gives it the present stamp.
  virtual void place_node(int side, int node) = 0;

 protected:
  ~NodePlacer() = default;
};

/// A surface in one configuration.
struct SurfaceView {
  const Eigen::Matrix4Xi& face;
  const Topology& topology;
  const Eigen::Matrix3Xd& x;     ///< 3 x n_nodes, m; with a placer of those nodes that were asked for
  double extension = 0;          ///< by which boundary sides are moved outwards, part of the face's length
  NodePlacer* placer = nullptr;  ///< null: all nodes are placed
  int side = 0;                  ///< of the placer
  const long *stamp = nullptr,
             *present = nullptr;  ///< of the placer: nodes with the present stamp are placed

  /// Position of a node, m.
  auto at(int node) const {
    if (placer && stamp[node] != *present) placer->place_node(side, node);
    return x.col(node);
  }
};

Face face_of(const SurfaceView& surface, int f);

/// Outward unit normal at a node: face normals weighted with the angles they have there; zero when
/// degenerate.
Eigen::Vector3d node_normal(const SurfaceView& surface, int node);

/// Sum of the unit normals that the faces at an edge have at parameter s from corner `side` of face f.
Eigen::Vector3d edge_normal(const SurfaceView& surface, int f, int side, double s);

/// Area each node stands for: integral of N_i over its faces, m^2.
Eigen::VectorXd node_areas(const Eigen::Matrix3Xd& x, const Eigen::Matrix4Xi& face);

/// Square root of the mean face area, m.
double face_size(const Eigen::Matrix3Xd& x, const Eigen::Matrix4Xi& face);

}  // namespace elastogear::contact
