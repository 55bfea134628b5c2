#pragma once
// Nested dissection of a sparse symmetric matrix into parts that are eliminated at once.

#include <vector>

#include "elastogear/base/petsc.h"

namespace elastogear::reduction {

/// Rows of the matrix: a leaf, or the separator of two children, whose rows have no entries in common.
struct Part {
  std::vector<int> row;       ///< ascending
  int left = -1, right = -1;  ///< parts that a separator separates; -1: it is a leaf

  bool is_leaf() const { return left < 0; }
};

/// Every row of A in one part. Children stand before their separators, the root is the last one. Leaves have
/// up to largest_leaf rows, or more where METIS finds no separator. Rows `kept`, ascending, are in no part.
/// A: sequential, of symmetric sparsity. Throws Error when METIS fails.
std::vector<Part> dissect(Mat A, int largest_leaf, const std::vector<int>& kept = {});

}  // namespace elastogear::reduction
