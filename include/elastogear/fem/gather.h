#pragma once
// From distributed block rows back to the mesh's order, on rank 0.

#include <Eigen/SparseCore>

#include "elastogear/base/petsc.h"
#include "elastogear/fem/share.h"

namespace elastogear::fem {

/// Gathers vectors over the free displacements, one at a time. Creating and calling it is collective.
class VectorGather {
 public:
  /// layout: any vector of the distribution; rows (read on rank 0) must outlive this.
  VectorGather(Vec layout, const RowNumbering& rows);
  /// All displacements (3 n_nodes, node-major, 0 where restrained) on rank 0, empty elsewhere.
  Eigen::VectorXd operator()(Vec v) const;

 private:
  UniqueScatter scatter_;
  UniqueVec on_root_;
  const RowNumbering* rows_;
};

/// The whole matrix on rank 0 over the free displacements in ascending order of 3 node + direction; empty
/// elsewhere. For small bodies: it is as large as it sounds. Collective.
Eigen::SparseMatrix<double> gather_matrix(Mat A, const RowNumbering& rows);

}  // namespace elastogear::fem
