#pragma once
// Fill-reducing order of elimination (METIS nested dissection).

#include <vector>

#include "elastogear/base/petsc.h"

namespace elastogear::reduction {

/// Position of every row of the symmetric A in the order of elimination, 0..n-1; on rank 0, empty elsewhere.
/// Rows of one node have equal neighbours, so that METIS works on the graph of nodes. Collective; rank 0
/// keeps the whole graph (one int per entry of A). Throws Error when METIS fails.
std::vector<int> nested_dissection(Mat A);

/// The same with the rows `last`, ascending, after all others, in this order. A: sequential.
std::vector<int> nested_dissection(Mat A, const std::vector<int>& last);

}  // namespace elastogear::reduction
