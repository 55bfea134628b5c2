#pragma once
// Attachment modes: what the eigenmodes leave out of the static responses to loads at markers, as further
// columns of the basis, Eq. (2.24). By them markers move under forces anywhere as in the whole body, Eq.
// (2.25).

#include "reduction/job/reduce_job.h"
#include "reduction/job/waiting_modes.h"

namespace elastogear::reduction {

/// Mass-normalised, orthogonal to the modes and to each other in the inner products of M and K.
struct Attachments {
  Eigen::MatrixXd phi;         ///< 3 n_nodes x n_a, 0 where restrained
  Eigen::VectorXd eigenvalue;  ///< n_a, rad^2/s^2, ascending: phi' K phi
};

/// Those of the markers of the job's body, on rank 0. whole: the whole body; null for a held one that repeats
/// around its axis. modes: all modes of the body, closed; read on rank 0. Collective.
Attachments find_attachments(Job& job, const ElasticSystem* whole, const WaitingModes* modes);

}  // namespace elastogear::reduction
