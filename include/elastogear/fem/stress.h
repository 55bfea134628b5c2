#pragma once
// Nodal stress: the element's extrapolated stresses, averaged at each node, or on free surfaces the stress
// that the strains of the surface and its zero traction give (docs/theory, section 1.5).
//
// The mean at a node is the plain (unweighted) mean over the adjacent cells of *one* material region. Across
// an interface stress jumps, so regions are never mixed: a node on an interface takes the region that comes
// first in the list of regions. Plain, because on hexahedra of unequal size a weight by volume would favour
// the cell whose stress was sampled farther away.

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

#include "elastogear/fem/stressed_body.h"
#include "elastogear/model/elastic_body.h"

namespace elastogear::fem {

/// The cells over which each node averages: its region, and the number of that region's cells at the node.
struct Averaging {
  std::vector<int> region_of_cell;
  std::vector<int> region, count;  ///< of each node

  bool counts(int cell, int node) const { return region_of_cell[cell] == region[node]; }
};

/// S at the given nodes, 6 n_e x 3 n_nodes, Pa/m: rows 6 i .. 6 i + 5 are xx yy zz xy yz xz at nodes[i].
/// Throws Error when a node belongs to no cell. docs/theory, Eq. (4.1).
model::SparseRows stress_operator(const StressedBody& body, const std::vector<int>& nodes);

/// What recovery on free surfaces gives at nodes less the mean there, whichever of them the body takes: 6 n_e
/// x 3 n_nodes, Pa/m; rows of zeros where no free surface is. docs/theory, Eq. (1.16).
model::SparseRows recovery_difference(StressedBody body, const std::vector<int>& nodes);

/// The same at nodes that are loaded, as if they were not, of what both make of the strains within the
/// surface: 6 n_e x 3 n_nodes, Pa/m; rows of zeros at nodes that are not loaded and inside the body.
/// docs/theory, Eq. (1.16a).
model::SparseRows difference_within_surface(StressedBody body, const std::vector<int>& nodes);

/// Index into `regions` of the region whose stress each node of the mesh has; -1 outside all cells.
std::vector<int> stress_regions(const mesh::Mesh& mesh, const std::vector<model::MaterialRegion>& regions);

/// Stresses at all nodes of a body, 6 n_nodes x k, Pa, of k displacements U (3 n_nodes x k, m, node-major),
/// without forming S at all of them. Nodes outside all cells get 0.
class NodalStresses {
 public:
  /// The body's mesh and regions outlive the object.
  explicit NodalStresses(const StressedBody& body);
  Eigen::MatrixXd operator()(const Eigen::MatrixXd& U) const;
  Eigen::MatrixXd means(const Eigen::MatrixXd& U) const;
  /// Nodes that take the stress of a free surface in place of the mean, ascending: none where the body takes
  /// means.
  const std::vector<int>& free() const { return free_; }
  /// S at these nodes, 6 n_free x 3 n_nodes, Pa/m.
  const model::SparseRows& of_free() const { return S_free_; }

 private:
  StressedBody body_;
  Averaging average_;
  std::vector<int> free_;
  model::SparseRows S_free_;
};

/// Stress at all nodes of one displacement u (3 n_nodes): 6 x n_nodes, Pa.
Eigen::MatrixXd nodal_stress(const StressedBody& body, const Eigen::VectorXd& u);

}  // namespace elastogear::fem
