#pragma once
// Mode acceleration: the part of the response to contact forces that truncated modes leave out, added
// statically (docs/theory.md, section 4.1).

#include <Eigen/Core>
#include <vector>

#include "elastogear/model/elastic_body.h"
#include "elastogear/model/result.h"

namespace elastogear::recovery {

/// Forces on a body over n_t times, at the n surface nodes that are touched at some time.
struct ForceHistory {
  std::vector<int> node;  ///< n, local numbers in the surface, ascending
  Eigen::MatrixXd force;  ///< 3 n x n_t, N, body frame
};

/// Contacts of one pair over time, and on which side of it (0 or 1) the body is.
struct PairContacts {
  int side = 0;
  std::vector<std::vector<model::ContactRecord>> contacts;  ///< n_t lists
};

/// Sum over the pairs. R_WB: 9 x n_t, row-major body to world. Throws Error when a record names a node or
/// face that the surface does not have.
ForceHistory contact_forces(const std::vector<PairContacts>& pairs, const model::Surface& surface,
                            const Eigen::MatrixXd& R_WB);

/// q - K_r^-1 Phi' f, n_q x n_t: the coordinates without their static response to the forces. With the
/// whole body's static response instead, u = Phi q_d + K^-1 f and sigma = Psi q_d + S K^-1 f. K_r is
/// diagonal. Eq. (4.3).
Eigen::MatrixXd dynamic_part(const model::ElasticBody& body, const Eigen::MatrixXd& q,
                             const ForceHistory& forces);

}  // namespace elastogear::recovery
