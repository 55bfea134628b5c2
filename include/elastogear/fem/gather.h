#pragma once
// From distributed block rows back to the mesh's order, on rank 0.

#include <Eigen/SparseCore>
#include <vector>

#include "elastogear/base/petsc.h"
#include "elastogear/fem/mesh_part.h"

namespace elastogear::fem {

/// Displacement 3 node + direction of every scalar row of the distributed matrices.
std::vector<int> row_dofs(const RowNumbering& rows);

/// Gathers vectors over the free displacements, one at a time. Creating and calling it is collective.
class VectorGather {
 public:
  /// layout: any vector of the distribution; rows are read on rank 0.
  VectorGather(Vec layout, const RowNumbering& rows);
  /// dof: row_dofs, on rank 0, of a body of n_dofs displacements.
  VectorGather(Vec layout, std::vector<int> dof, int n_dofs);
  /// All displacements (3 n_nodes, node-major, 0 where restrained) on rank 0, empty elsewhere.
  Eigen::VectorXd operator()(Vec v) const;
  /// The way back: v := u at the free displacements; u (3 n_nodes) is read on rank 0.
  void scatter(const Eigen::VectorXd& u, Vec v) const;
  /// Displacement of every scalar row, on rank 0.
  const std::vector<int>& dof() const { return dof_; }

 private:
  UniqueScatter scatter_;
  UniqueVec on_root_;
  std::vector<int> dof_;
  int n_dofs_;
};

/// The matrix with every row and column on rank 0. Collective.
UniqueMat on_root(Mat A);

/// The whole matrix on rank 0 over the free displacements in ascending order of 3 node + direction; empty
/// elsewhere. For small bodies: it is as large as it sounds. Collective.
Eigen::SparseMatrix<double> gather_matrix(Mat A, const RowNumbering& rows);
/// The whole matrix on rank 0 for scalar rows; dof: the displacement of every row.
Eigen::SparseMatrix<double> gather_matrix(Mat A, const std::vector<int>& dof);

}  // namespace elastogear::fem
