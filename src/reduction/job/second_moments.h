#pragma once
// The second moments S^ab of shape functions (docs/theory, Eq. (3.11a)), model::Inertia::S_2.

#include <Eigen/Core>
#include <vector>

#include "elastogear/fem/inertia.h"
#include "elastogear/model/elastic_body.h"
#include "reduction/job/waiting_modes.h"

namespace elastogear::reduction {

/// S^ab of closed modes for ab = 11 22 33 12 23 13, n_q x n_q each, in 12 n n_q^2 operations for the n fields
/// of the mass. Memory: about 1 GB, and the 6 n_q x n_q results.
std::vector<model::BasisRows> second_moments(const WaitingModes& modes, const fem::FieldMass& mass);

/// M u of displacements at all nodes, 3 n_nodes x n, node-major; nothing of nothing.
Eigen::MatrixXd times(const fem::FieldMass& mass, const Eigen::MatrixXd& u);

/// Second moments of the unit basis: the mass between directions a and b of the free displacements, sparse.
std::vector<model::BasisRows> unit_second_moments(const fem::FieldMass& mass,
                                                  const std::vector<int>& free_dof);

}  // namespace elastogear::reduction
