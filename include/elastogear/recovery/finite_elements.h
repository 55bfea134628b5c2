#pragma once
// Recovery needs two answers of a whole body's finite elements, which belong to the modules that make bodies
// and which it does not include: the caller hands them in, as src/drive/finite_elements.cpp does.

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "elastogear/io/body_file.h"

namespace elastogear::recovery {

/// Static response of the unreduced body to forces on its nodes, K^-1 f and S K^-1 f. Nodes are mesh numbers.
struct UnreducedResponse {
  /// Displacement, 3 n_nodes x n_t, m, node-major, for forces f (3 n x n_t, N) on the n nodes `loaded`.
  std::function<Eigen::MatrixXd(const std::vector<int>& loaded, const Eigen::MatrixXd& f)> displacement;
  /// Stress at the n_e nodes `evaluated` for unit forces in x, y, z on each of `loaded`: 6 n_e x 3 n, Pa/N.
  std::function<Eigen::MatrixXd(const std::vector<int>& loaded, const std::vector<int>& evaluated)> stress;
};

/// Around n nodes of the boundary.
struct SurfacePatches {
  std::vector<std::vector<int>> node;  ///< n, mesh numbers: each node and those that share a face with it
  std::vector<int> order;              ///< n, degree of the displacements in the cells at each node
};

/// Stresses of a body, Pa, of k displacements U (3 n_nodes x k, m, node-major), by both recoveries.
struct NodalStresses {
  std::function<Eigen::MatrixXd(const Eigen::MatrixXd& U)> means;  ///< at all nodes, 6 n_nodes x k
  std::vector<int> free;      ///< n_free, nodes on free surfaces that are not loaded, ascending
  model::SparseRows of_free;  ///< the stress operator of the free surfaces there, 6 n_free x 3 n_nodes, Pa/m
};

struct FiniteElements {
  /// Factorises K of a body. The source outlives the response. floating: nothing holds the body, whose loads
  /// are balanced by its inertia.
  std::function<UnreducedResponse(const io::BodySource& source, bool floating)> unreduced_response;
  /// Finds what the mesh costs once. The source outlives the stresses. loaded: nodes on which forces act,
  /// which bodies whose stresses are means do not know.
  std::function<NodalStresses(const io::BodySource& source, const std::vector<int>& loaded)> nodal_stresses;
  /// Index into the source's regions of the region whose stress each node has; -1: none. Asked of
  /// viscoelastic bodies.
  std::function<std::vector<int>(const io::BodySource& source)> node_regions = {};
  /// Stresses at nodes as recovered on free surfaces less the means there, 6 n x 3 n_nodes, Pa/m; rows of
  /// zeros at `loaded` nodes and where no free surface is.
  std::function<model::SparseRows(const io::BodySource& source, const std::vector<int>& loaded,
                                  const std::vector<int>& nodes)>
      recovery_difference = {};
  /// The same at `loaded` nodes as if they were not, of the strains within the surface, Eq. (1.16a).
  std::function<model::SparseRows(const io::BodySource& source, const std::vector<int>& loaded,
                                  const std::vector<int>& nodes)>
      difference_within_surface = {};
  /// Rows of the stress operator at nodes, as the body takes its stresses: 6 n x 3 n_nodes, Pa/m.
  std::function<model::SparseRows(const io::BodySource& source, const std::vector<int>& nodes)>
      stress_operator = {};
  std::function<SurfacePatches(const io::BodySource& source, const std::vector<int>& nodes)> surface_patches =
      {};
};

}  // namespace elastogear::recovery
