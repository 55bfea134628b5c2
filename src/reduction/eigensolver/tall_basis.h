#pragma once
// Hundreds of long vectors, kept so that products with a few others run near the speed of memory.

#include <Eigen/Core>
#include <memory>

#include "elastogear/base/instructions.h"

namespace elastogear::reduction {

/// n_rows x capacity. Rows lie in slabs, within a slab column after column: a
/// sweep over all columns reads memory in order, each entry once for all the vectors it is multiplied with.
/// A matrix product by BLAS copies V first, which costs as much as multiplying with 8 to 16 vectors.
/// All instructions compute the same but for roundoff.
class TallBasis {
 public:
  TallBasis() = default;
  /// Memory is taken as columns come in.
  TallBasis(Eigen::Index n_rows, int capacity, Instructions instructions = best_instructions());

  int capacity() const { return capacity_; }
  Eigen::Index n_rows() const { return n_rows_; }
  /// Columns first, first + 1, ... := Q.
  void set(int first, const Eigen::Ref<const Eigen::MatrixXd>& Q);
  /// Columns first, first + 1, ..., n of them.
  Eigen::MatrixXd get(int first, int n) const;
  /// V' W of the first n columns V: n x columns of W.
  Eigen::MatrixXd dot(int n, const Eigen::Ref<const Eigen::MatrixXd>& W) const;
  /// Y += V C for the C.rows() columns V from `first` on, as many rows of them as Y has.
  void add_product(int first, const Eigen::Ref<const Eigen::MatrixXd>& C,
                   Eigen::Ref<Eigen::MatrixXd> Y) const;

 private:
  double* at(Eigen::Index slab, int column) const;

  Eigen::Index n_rows_ = 0, n_slabs_ = 0;
  int capacity_ = 0;
  Instructions instructions_ = Instructions::portable;
  std::unique_ptr<double[]> values_;  // not set to zero: pages that are not used take no memory
};

}  // namespace elastogear::reduction
