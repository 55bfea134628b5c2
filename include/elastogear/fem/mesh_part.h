#pragma once
// Block rows of K and M, and what each MPI rank needs of the mesh to fill its own.
//
// Every free node is one block row of three. A rank owns a contiguous range of rows and receives *all* cells
// that touch one of its nodes, so that it completes its rows alone: assembly needs no communication, and
// each entry is the sum of the same numbers in the same order on any number of ranks. Cells on the border
// between two ranks are computed twice.

#include <mpi.h>

#include <vector>

#include "elastogear/mesh/mesh.h"

namespace elastogear::fem {

/// Block rows of all nodes; valid on the rank that has the mesh.
struct RowNumbering {
  std::vector<int> row;        ///< per node: block row, -1 for nodes without displacements
  std::vector<int> node;       ///< per block row: node
  std::vector<int> row_begin;  ///< per rank its first block row, then the number of all
};

/// Owners of nodes are read off the cells' parts (the part of the first cell at a node); rows of one rank
/// follow the mesh's order. part: rank of each cell.
RowNumbering number_rows(const mesh::Mesh& mesh, const std::vector<bool>& is_free,
                         const std::vector<int>& part, int n_ranks);

/// One rank's part of the body, in local node numbers.
struct MeshPart {
  mesh::Mesh mesh;                 ///< all cells that touch a node of this rank, without named sets
  std::vector<int> region;         ///< material region of each cell
  std::vector<int> row;            ///< block row of each local node, -1: none
  int row_begin = 0, row_end = 0;  ///< this rank's block rows
};

/// Sends each rank its part. Collective; mesh, region (of each cell) and rows are read on rank 0 only.
MeshPart distribute(MPI_Comm comm, const mesh::Mesh& mesh, const std::vector<int>& region,
                    const RowNumbering& rows);

}  // namespace elastogear::fem
