#pragma once
// How far a surface is deformed at most, from the elastic energy alone (docs/theory, Eq. (5.4)): with C =
// Phi_i K_r^-1 Phi_i' of node i, |Phi_i q|^2 <= |C| q'K_r q. Costs n_q operations and touches no node.

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "elastogear/model/elastic_body.h"

namespace elastogear::contact {

struct DeformationBound {
  const model::BasisRows* Phi = nullptr;  ///< borrowed
  Eigen::VectorXd stiffness;              ///< n_q, diagonal of K_r; empty: the nodes themselves are looked at
  double compliance = 0;                  ///< largest |Phi_i K_r^-1 Phi_i'| of all nodes, m/N per unit force
};

/// Bound by the elastic energy for a dense basis and a positive diagonal K_r. Otherwise (full basis, whose
/// rows are sparse, or no K_r given) the displacements of all nodes are taken.
DeformationBound deformation_bound(const model::BasisRows& Phi, const Eigen::SparseMatrix<double>& K_r);

/// >= max over the nodes of |Phi_i q|, m. Eq. (5.4).
double largest_displacement(const DeformationBound& bound, const Eigen::VectorXd& q);

}  // namespace elastogear::contact
