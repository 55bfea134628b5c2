#pragma once
// The mass of a cell, whose displacements may have incompatible modes (docs/theory, section 1.1).

#include <Eigen/Core>

#include "elastogear/fem/element.h"

namespace elastogear::fem {

/// Mass of a cell with the displacements u = sum_a N_a u_a + sum_k P_k alpha_k of its nodal functions N_a and
/// of modes P_k that vanish at the nodes, with the amplitudes alpha = T u_e: docs/theory, Eq. (1.5a).
struct CellMass {
  Eigen::MatrixXd scalar;  ///< kg, integral of rho f_i f_j dV for the N_a, then the P_k
  Eigen::MatrixXd T;       ///< -, 3 n_P x 3 n_nodes, row 3 k + d; empty: the cell has no modes

  bool has_modes() const { return T.size() > 0; }
  Eigen::Index n_modes() const { return T.rows() / 3; }
  Eigen::Index n_nodes() const { return scalar.rows() - n_modes(); }
};

/// X: 3 x n_nodes, m; rho in kg/m^3; elasticity that of the whole material.
CellMass cell_mass(mesh::CellType type, const Eigen::Matrix3Xd& X, double rho, const Elasticity& elasticity,
                   const model::Formulation& formulation);

/// The consistent mass of the cell's displacements, 3 n_nodes square, kg. Eqs. (1.3) and (1.5b).
Eigen::MatrixXd mass_matrix(const CellMass& mass);

}  // namespace elastogear::fem
