#pragma once
// Mass moments of a mesh (docs/theory.md, section 3.1).

#include <Eigen/Core>
#include <vector>

#include "elastogear/mesh/mesh.h"
#include "elastogear/model/elastic_body.h"
#include "elastogear/model/material.h"

namespace elastogear::fem {

/// Products of the scalar consistent mass M_s of *all* nodes, restrained ones included, with the constant and
/// the linear field: all that rigid-body inertia and its coupling to shape functions need.
struct MassMoments {
  Eigen::VectorXd w_0;   ///< n_nodes, kg: M_s 1
  Eigen::Matrix3Xd w_1;  ///< 3 x n_nodes, kg m: column i = sum_j M_s(i,j) X_j
};

/// Scalar mass M_s of all nodes, n_nodes x n_nodes, kg.
model::SparseRows scalar_mass(const mesh::Mesh& mesh, const std::vector<model::MaterialRegion>& regions);

MassMoments mass_moments(const mesh::Mesh& mesh, const std::vector<model::MaterialRegion>& regions);

/// m, c, J about the BRF origin; coupling terms stay empty. Eq. (3.9).
model::Inertia rigid_inertia(const mesh::Mesh& mesh, const MassMoments& moments);

/// integral of rho X_a phi_b dV as a 3x3 matrix (row a, column b), for phi given at all nodes (3 n_nodes).
/// Eq. (3.10).
Eigen::Matrix3d first_moment(const MassMoments& moments, const Eigen::VectorXd& phi);

/// integral of rho phi dV: one row of C_l. Eq. (3.10).
Eigen::Vector3d translational_coupling(const MassMoments& moments, const Eigen::VectorXd& phi);

/// integral of rho X x phi dV: one row of C_r, the antisymmetric part of the first moment. Eq. (3.10).
Eigen::Vector3d rotational_coupling(const Eigen::Matrix3d& first_moment);

}  // namespace elastogear::fem
