#pragma once
// Coordinates q of a body and what belongs to them: inertia coupling, surface rows, stress modes, M_r, K_r.

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

#include "elastogear/fem/inertia.h"
#include "elastogear/model/elastic_body.h"

namespace elastogear::reduction {

/// Sizes the body's dense fields for n_q modes: zero until set_mode.
void allocate_modes(model::ElasticBody& body, int n_q);

/// Makes room for n more modes behind those of the body.
void add_modes(model::ElasticBody& body, int n);

/// All numbers that the body keeps of a mode, in one column: rows of Phi (surface), of Psi = S phi (stress)
/// and of the markers' Phi, those of C_l, C_r and S_1. phi: 3 n_nodes, node-major. S: the stress operator at
/// body.stress.node, then the operator of body.markers (reduction/marker.h).
Eigen::VectorXd mode_column(const model::ElasticBody& body, const Eigen::VectorXd& phi,
                            const fem::MassMoments& moments, const model::SparseRows& S);
/// Enters the column of mode_column as mode k.
void set_mode(model::ElasticBody& body, int k, const Eigen::VectorXd& column);

/// M_r = I, K_r = diag(eigenvalue), frequencies in Hz.
void set_modal_matrices(model::ElasticBody& body, const Eigen::VectorXd& eigenvalue);

/// Unit basis: one coordinate per free displacement, in the order of free_dof (ascending). All rows sparse.
void set_full_basis(model::ElasticBody& body, const std::vector<int>& free_dof,
                    const fem::MassMoments& moments, const model::SparseRows& S);

}  // namespace elastogear::reduction
