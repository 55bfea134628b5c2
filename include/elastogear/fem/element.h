#pragma once
// The table of elements: what assembly and stress recovery need of each cell type.

#include <Eigen/Core>
#include <optional>

#include "elastogear/fem/material.h"

namespace elastogear::fem {

/// Functions of one cell type. X: 3 x n_nodes, m. Results as in fem/hex8.h with n_nodes in place of 8.
struct ElementFunctions {
  int n_nodes;
  double (*smallest_jacobian)(const Eigen::Matrix3Xd& X);
  double (*volume)(const Eigen::Matrix3Xd& X);
  Eigen::MatrixXd (*stiffness)(const Eigen::Matrix3Xd& X, const Elasticity& material, model::Element element);
  /// Stiffness by a part of the material's elasticity. Incompatible modes have the amplitudes that they have
  /// with all of it, so that parts sum to the whole.
  Eigen::MatrixXd (*stiffness_of_part)(const Eigen::Matrix3Xd& X, const Elasticity& material,
                                       const Elasticity& part, model::Element element);
  Eigen::MatrixXd (*mass)(const Eigen::Matrix3Xd& X, double rho);  ///< scalar, n_nodes x n_nodes
  Eigen::MatrixXd (*stress)(const Eigen::Matrix3Xd& X, const Elasticity& material, model::Element element);
};

/// The functions of a cell type; Error when there is no element for it.
const ElementFunctions& element_functions(mesh::CellType type);

/// Moduli by which the stiffness of cells of one material is computed.
struct CellModuli {
  explicit CellModuli(const model::Material& material);
  Elasticity elastic;                 ///< instantaneous, by which incompatible modes have their amplitudes
  std::optional<Elasticity> relaxed;  ///< where some share of them is gone
};
/// Stiffness of a cell with what is left of the moduli; a sum of the parts of Eq. (1.13).
Eigen::MatrixXd cell_stiffness(const ElementFunctions& functions, const Eigen::Matrix3Xd& X,
                               const CellModuli& moduli, model::Element element);

/// Coordinates of a cell's nodes, 3 x n_nodes.
Eigen::Matrix3Xd cell_coordinates(const mesh::Mesh& mesh, int cell);

/// Throws Error naming the cell, its nodes and the value where the Jacobian is not positive.
void require_positive_jacobians(const mesh::Mesh& mesh);

}  // namespace elastogear::fem
