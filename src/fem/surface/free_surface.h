#pragma once
// The surfaces of a body on which no force acts, by construction: which of them meet at a node, and the nodes
// around it on each.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "elastogear/fem/stressed_body.h"

namespace elastogear::fem {

/// A smooth piece of free surface at a node.
struct Sheet {
  std::vector<int> face;  ///< those at the node
  Eigen::Vector3d n;      ///< outward unit normal, the mean of theirs
};

/// The faces of the boundary of one mesh. Sides of second-order cells are cut as the contact surface is.
class FreeSurface {
 public:
  /// region: of each cell. The mesh outlives this.
  FreeSurface(const StressedBody& body, const std::vector<int>& region);

  /// The free sheets that meet at a node: one on a smooth surface, more at convex edges and corners. None:
  /// inside the body, on nodes that are loaded, held or between regions, at reentrant edges and at edges that
  /// are neither smooth nor sharp.
  std::vector<Sheet> sheets(int node) const;

  /// Nodes of the sheet's faces and of `rings` - 1 rings of smoothly joined faces around them,
  /// ascending. They stay within the region, and where normals are less than 60 degrees from the sheet's.
  std::vector<int> patch(const Sheet& sheet, int rings) const;

 private:
  /// How two faces meet at an edge. none: both are free of each other, at a plane of symmetry.
  enum class Joint { none, smooth, sharp, unclear };
  Joint joint(int f, int g) const;
  bool continues(int f, int g, const Sheet& sheet) const;
  bool is_smoothly_held(int node) const;
  std::span<const int> faces_at(int node) const;
  Eigen::Vector3d middle(int f) const;

  const mesh::Mesh& mesh_;
  std::vector<mesh::Face> face_;
  std::vector<int> region_;                // of each face
  Eigen::Matrix3Xd n_;                     // outward unit normal of each face
  std::vector<mesh::Directions> support_;  // directions in which each face is supported; 0: free
  std::vector<int> offset_, at_node_;      // faces at each node, in compressed rows
  std::vector<mesh::Directions> held_;     // of each node
  std::vector<bool> averaged_;             // of each node: loaded, held wholly or between regions
};

}  // namespace elastogear::fem
