#pragma once
// Further columns of the low rank part W k V' of an EffectiveMatrix. Private to module dynamics.

#include <vector>

#include "elastogear/dynamics/effective_matrix.h"

namespace elastogear::dynamics {

/// Adds n columns of zeros to W, V and k; returns the first.
Eigen::Index add_columns(Eigen::Index n, EffectiveMatrix& A);
/// A(row.., column..) += block, without its zeros.
void add_block(Eigen::Index row, Eigen::Index column, const Eigen::MatrixXd& block,
               Eigen::SparseMatrix<double>& A);
/// L, and L_V and L_x where contact has its own.
std::vector<Eigen::SparseMatrix<double>*> elastic_rows(BodyTerms& terms);
/// Rows of V on the columns E of the body, n_e x r: L_V, or L where V is W.
const Eigen::SparseMatrix<double>& displacement_rows(const BodyTerms& terms);
/// The same without rates: rows of residual displacements.
const Eigen::SparseMatrix<double>& position_rows(const BodyTerms& terms);
/// A += E_u Z E_u' on a body's elastic coordinates, with the first columns E_u of E; empty Z: nothing.
void add_border_stiffness(const Eigen::MatrixXd& Z, std::size_t b, EffectiveMatrix& A);

}  // namespace elastogear::dynamics
