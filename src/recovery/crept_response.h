#pragma once
// The part of static responses that comes by creep, in viscoelastic bodies of several materials
// (docs/theory, section 4.5).

#include "elastogear/recovery/static_response.h"

namespace elastogear::recovery {

/// chi_k of the loaded nodes at each output time, of forces that are linear in between, and the coordinates
/// K_r^-1 Phi' chi_k of the instantaneous body and those of the state, Eq. (4.12). Nothing for a body that
/// relaxes in one ratio everywhere. forces: of the body's surface.
std::optional<CreptResponse> crept_response(const BodyOfRun& body, const model::ElasticBody& elastic,
                                            const model::ForceHistory& forces);

/// 6 n x n_t, Pa: the stress by which the modes' part of it is to be added, at these evaluation nodes (local
/// numbers).
Eigen::MatrixXd crept_modal_stress(const model::ElasticBody& elastic, const std::vector<int>& members,
                                   const CreptResponse& crept);

}  // namespace elastogear::recovery
