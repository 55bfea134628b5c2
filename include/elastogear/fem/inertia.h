#pragma once
// Mass moments of a mesh (docs/theory, section 3.1).

#include <Eigen/Core>
#include <vector>

#include "elastogear/mesh/mesh.h"
#include "elastogear/model/elastic_body.h"
#include "elastogear/model/material.h"

namespace elastogear::fem {

/// Moments of mass of the displacements of *all* nodes, restrained ones included: all that rigid-body inertia
/// and its coupling to shape functions need. docs/theory, section 3.1.
struct MassMoments {
  Eigen::VectorXd w_0;   ///< n_nodes, kg: integral of rho N_i dV
  Eigen::Matrix3Xd w_1;  ///< 3 x n_nodes, kg m: column i = integral of rho X N_i dV
  /// 12 x 3 n_nodes, or without columns: what incompatible modes add per nodal displacement. Row b, in kg: to
  /// the integral of rho u_b dV; row 3 + 3 a + b, in kg m: to that of rho X_a u_b dV. Eq. (3.10a).
  Eigen::Matrix<double, 12, Eigen::Dynamic> modes = {};

  Eigen::Index n_nodes() const { return w_0.size(); }
};

/// Mass of a mesh between fields: the displacements of nodes and, behind them, the amplitudes of incompatible
/// modes, each with a row for each direction.
struct FieldMass {
  model::SparseRows M_s;     ///< kg, n x n, n = n_nodes + number of modes
  model::SparseRows T = {};  ///< 3 (n - n_nodes) x 3 n_nodes: amplitudes from nodal displacements; or empty
};

/// The mass between the fields of all nodes and modes.
FieldMass field_mass(const mesh::Mesh& mesh, const std::vector<model::MaterialRegion>& regions,
                     const model::Formulation& formulation = {});

MassMoments mass_moments(const mesh::Mesh& mesh, const std::vector<model::MaterialRegion>& regions,
                         const model::Formulation& formulation = {});

/// Moves the origin of coordinates, about which first moments are, to the point `origin` (m).
void move_origin(MassMoments& moments, const Eigen::Vector3d& origin);

/// m, c, J about the BRF origin; coupling terms stay empty. Eq. (3.9).
model::Inertia rigid_inertia(const mesh::Mesh& mesh, const MassMoments& moments);

/// M_f r at all nodes, 3 n_nodes, of the rigid motion r = t + w x X.
Eigen::VectorXd momentum(const MassMoments& moments, const Eigen::Vector3d& t, const Eigen::Vector3d& w);

/// integral of rho X_a phi_b dV as a 3x3 matrix (row a, column b), for phi given at all nodes (3 n_nodes).
/// Eq. (3.10).
Eigen::Matrix3d first_moment(const MassMoments& moments, const Eigen::VectorXd& phi);

/// The same for the unit displacement number 3 node + direction.
Eigen::Matrix3d first_moment(const MassMoments& moments, int dof);
Eigen::Vector3d translational_coupling(const MassMoments& moments, int dof);

/// integral of rho phi dV: one row of C_l. Eq. (3.10).
Eigen::Vector3d translational_coupling(const MassMoments& moments, const Eigen::VectorXd& phi);

/// integral of rho X x phi dV: one row of C_r, the antisymmetric part of the first moment. Eq. (3.10).
Eigen::Vector3d rotational_coupling(const Eigen::Matrix3d& first_moment);

}  // namespace elastogear::fem
