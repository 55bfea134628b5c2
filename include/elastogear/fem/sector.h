#pragma once
// One sector of a cyclically symmetric body of Z sectors, and displacements of one harmonic on it
// (docs/theory, section 2.6).

#include <mpi.h>

#include <Eigen/Core>
#include <vector>

#include "elastogear/mesh/mesh.h"
#include "elastogear/mesh/repetition.h"

namespace elastogear::fem {

/// Orbit and sector of each node, which is the first node of its orbit, turned by 2 pi sector_index/Z.
struct NodeOrbits {
  std::vector<int> orbit;         ///< of each node, counted over the free orbits; -1: no displacements
  std::vector<int> sector_index;  ///< of each node
};

/// Data for the element matrices of a sector; the same on all ranks.
struct Sector {
  mesh::Turn turn;
  mesh::Mesh mesh;             ///< one cell of each orbit, in local nodes, without sets
  std::vector<int> region;     ///< of each cell
  std::vector<double> weight;  ///< of each cell: its images over Z, below 1 around the axis
  NodeOrbits node_orbits;      ///< of the local nodes
  std::vector<char> on_axis;   ///< of each free orbit

  int n_orbits() const { return static_cast<int>(on_axis.size()); }
};

/// Free orbits of all nodes of the mesh.
NodeOrbits free_node_orbits(const mesh::Repetition& repetition, const std::vector<bool>& is_free);

/// region: of each cell of the mesh.
Sector make_sector(const mesh::Mesh& mesh, const mesh::Repetition& repetition, const std::vector<int>& region,
                   const NodeOrbits& node_orbits);

/// Copies rank 0's sector to all ranks. Collective.
void broadcast(MPI_Comm comm, Sector& sector);

/// The sector by itself, cut open: each of its free nodes is an orbit of its own, with all directions, in the
/// frame that is turned with it. Of its harmonic 0 the coordinates are displacements in these frames.
Sector cut_open(const Sector& sector);

/// Displacements u_j = R^j Re(z exp(2 pi i j k/Z)) on the sectors j = 0..Z-1 with complex amplitudes z of the
/// sector, which are real for k = 0 and 2 k = Z. Coordinates of an orbit: Re z then Im z (3 + 3, or 3 when
/// real); on the axis those along the directions that the turn allows. Eq. (2.10).
struct Harmonic {
  int k = 0, n_sectors = 1;
  bool real = true;
  std::vector<Eigen::MatrixXd> turned;  ///< for each sector: (Re u, Im u) of a node from coordinates
  Eigen::MatrixXd on_axis;              ///< the same for nodes on the axis; possibly without columns
  std::vector<int> first;               ///< of each free orbit its first coordinate, then their number

  int size() const { return first.back(); }
  const Eigen::MatrixXd& at(bool axis, int sector_index) const {
    return axis ? on_axis : turned[sector_index];
  }
};

/// Harmonic k of a sector, 0 <= k <= Z/2.
Harmonic make_harmonic(const Sector& sector, int k);

/// Displacements of the whole mesh (3 n_nodes, node-major, 0 where restrained) from coordinates z of a
/// harmonic. z' M_k z = 1 makes them mass-normalised. Eq. (2.14).
Eigen::VectorXd unfold(const Harmonic& harmonic, const NodeOrbits& node_orbits,
                       const Eigen::Ref<const Eigen::VectorXd>& z);

/// What forces f at all nodes (3 n_nodes, N) are along the coordinates of a harmonic: f' u = g' z for the
/// displacements u that follow from z as above.
Eigen::VectorXd project_forces(const Harmonic& harmonic, const NodeOrbits& node_orbits,
                               const Eigen::Ref<const Eigen::VectorXd>& f);

/// Coordinates of i z, the second real field of a complex amplitude; the harmonic must not be real. Rows may
/// be those of some orbits only.
Eigen::MatrixXd times_i(const Harmonic& harmonic, int first_orbit,
                        const Eigen::Ref<const Eigen::MatrixXd>& z);

/// Coordinates of the rigid motions that a harmonic contains, a column each, of any scale: two for k = 0,
/// four for k = 1, none for others. The body must be free.
Eigen::MatrixXd rigid_fields(const Harmonic& harmonic, const Sector& sector);

}  // namespace elastogear::fem
