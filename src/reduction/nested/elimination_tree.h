#pragma once
// The elimination tree of a matrix by nested dissection: its parts, whose rows are eliminated together, their
// order, and the rows that each part is tied to.

#include <Eigen/SparseCore>
#include <vector>

#include "elastogear/base/petsc.h"

namespace elastogear::reduction {

/// A leaf, or a separator of two children. Rows of K are numbered in the order of elimination.
struct TreePart {
  int first, end;             ///< rows of K
  int left = -1, right = -1;  ///< parts that a separator separates; -1: it is a leaf
  std::vector<int> border{};  ///< rows of K that are left and tied to it or to what is below, ascending
  std::vector<int> row{};     ///< rows of P with entries in it or below, ascending

  int n_rows() const { return end - first; }
};

struct EliminationTree {
  std::vector<int> position;   ///< of each row of K in the order of elimination; kept rows are the last
  std::vector<int> at;         ///< row of K at each position
  std::vector<TreePart> part;  ///< children before their separators
};

/// P: what is wanted, by columns. Rows `kept` of K, ascending, are not eliminated. Throws Error as dissect().
EliminationTree make_tree(Mat K, const Eigen::SparseMatrix<double>& P, int largest_leaf,
                          const std::vector<int>& kept);

}  // namespace elastogear::reduction
