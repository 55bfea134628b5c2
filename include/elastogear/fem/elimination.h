#pragma once
// Single displacements taken out of assembled matrices.

#include <vector>

#include "elastogear/fem/assembly.h"
#include "elastogear/mesh/hold.h"

namespace elastogear::fem {

/// Takes the rows and columns of held displacements out of both matrices. dof: 3 node + direction of every
/// scalar row, becomes that of the rows that are left; held: directions of each node. Both are read on rank
/// 0. Collective.
void eliminate(const std::vector<mesh::Directions>& held, Matrices& matrices, std::vector<int>& dof);

}  // namespace elastogear::fem
