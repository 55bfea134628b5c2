#pragma once
// K and M of another program: read on rank 0, distributed, checked (docs/theory, section 2.5).

#include <mpi.h>

#include <cstdint>
#include <string>
#include <vector>

#include "elastogear/base/progress.h"
#include "elastogear/fem/assembly.h"
#include "elastogear/fem/gather.h"
#include "elastogear/fem/inertia.h"
#include "elastogear/io/matrix_text.h"
#include "elastogear/mesh/mesh.h"
#include "elastogear/model/elastic_body.h"

namespace elastogear::reduction {

struct ImportedFiles {
  std::string stiffness, mass;  ///< paths
  std::string dofs = {};  ///< path, names the rows of calculix and triplets; empty: 3 rows a node in order
  io::MatrixFormat format = io::MatrixFormat::automatic;
  double stiffness_unit = 1;                   ///< N/m, of the stiffness' numbers
  double mass_unit = 1;                        ///< kg
  std::vector<std::int64_t> node_number = {};  ///< of the mesh's nodes in the files, ascending; empty: from 1
};

/// Rows are the displacements that the files have, ascending.
struct ImportedSystem {
  fem::Matrices matrices;
  std::vector<int> dof;  ///< of every row: 3 node + direction; on rank 0
};

/// Reads both matrices, each whole or as one half (the other follows by symmetry); entries given twice are
/// added. Displacements whose stiffness is 1e36 or more on the diagonal (Abaqus' boundary conditions) are
/// left out. Each rank owns the nodes of an equal stretch of the numbering. mesh (nodes at least) and files
/// are read on rank 0. Collective. Throws the same Error on all ranks for what io::MatrixReader throws,
/// unknown nodes and rows, asymmetry, diagonals that are not positive, and displacements that only one of the
/// matrices has.
ImportedSystem read_imported(MPI_Comm comm, const mesh::Mesh& mesh, const ImportedFiles& files,
                             const Progress& progress = {});

/// Does `dof` hold all displacements of every node (of a cell, when there are cells)?
bool is_complete(const mesh::Mesh& mesh, const std::vector<int>& dof);

/// Mass moments from a complete M itself. Collective, result on rank 0. Throws Error unless M is a scalar
/// matrix times I_3 to rounding, as solid elements in one coordinate system have it.
fem::MassMoments mass_moments(Mat M, const fem::VectorGather& gather, const mesh::Mesh& mesh);

/// M_s of M = M_s x I_3 between all nodes (n_nodes x n_nodes, kg), zero where displacements lack, as
/// SecondMoments takes it. n_nodes is read on rank 0. Collective, result on rank 0. Throws Error when M
/// couples directions or has different entries in them, beyond rounding, and when nodes that lack some
/// displacements leave entries unknown.
model::SparseRows scalar_mass(const ImportedSystem& system, int n_nodes);

/// Throws Error naming `what` when conjugate gradients (a few hundred steps) meet a direction in which A is
/// not positive. Collective.
void require_positive(Mat A, const std::string& what);

}  // namespace elastogear::reduction
