#pragma once
// How far recovered stresses are from those of the continuum: an estimate from two recoveries of the same
// displacements (docs/theory, section 1.7).

#include <Eigen/Core>

#include "elastogear/io/stress_file.h"
#include "elastogear/recovery/recover.h"

namespace elastogear::recovery {

/// n x n_t, Pa, at the nodes of a set whose stresses are recovered: Eq. (1.18). Empty where it cannot be
/// told: the body is viscoelastic or comes from matrices, its file lacks the modes at all nodes, or no node
/// of the set is on a free surface.
Eigen::MatrixXd mesh_error(const RecoveredBody& body, const model::ElasticBody& elastic,
                           const io::StressSet& set);

}  // namespace elastogear::recovery
