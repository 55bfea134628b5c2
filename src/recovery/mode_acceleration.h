#pragma once
// Mode acceleration: the part of the response to contact forces that truncated modes leave out, added
// statically (docs/theory, section 4.1).

#include <Eigen/Core>

#include "elastogear/model/elastic_body.h"
#include "elastogear/model/result.h"

namespace elastogear::recovery {

/// q - K_r^-1 Phi' f, n_q x n_t: the coordinates without their static response to the forces. With the
/// whole body's static response instead, u = Phi q_d + K^-1 f and sigma = Psi q_d + S K^-1 f. K_r is
/// diagonal. Eq. (4.3).
Eigen::MatrixXd dynamic_part(const model::ElasticBody& body, const Eigen::MatrixXd& q,
                             const model::ForceHistory& forces);

/// q_d without the static response to loads at markers, of a body that has attachment modes: Eq. (4.3b).
Eigen::MatrixXd without_marker_loads(const model::ElasticBody& body, const Eigen::MatrixXd& q_d);

/// What is dynamic in the coordinates of a viscoelastic body, n_q x n_t: its instantaneous response to the
/// forces of inertia. q_d: its coordinates without their instantaneous response to the contact forces; w:
/// n_q n_p x n_t. Eq. (4.12a).
Eigen::MatrixXd inertial_part(const model::ElasticBody& body, const Eigen::MatrixXd& q_d,
                              const Eigen::Ref<const Eigen::MatrixXd>& w);

}  // namespace elastogear::recovery
