#pragma once
// Balanced distribution of cells over ranks (METIS).

#include <vector>

#include "elastogear/mesh/mesh.h"

namespace elastogear::mesh {

struct Partition {
  std::vector<int> part;  ///< n_cells, 0..n_parts-1
  int edge_cut = 0;       ///< pairs of cells that share a face and lie in different parts
};

/// Recursive bisection of the dual graph (cells that share a face). The same mesh gives the same partition
/// every time. Error unless 1 <= n_parts <= n_cells.
Partition partition_cells(const Mesh& mesh, int n_parts);

}  // namespace elastogear::mesh
