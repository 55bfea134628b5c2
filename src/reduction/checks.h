#pragma once
// The checks of a modal reduction, as they are stored and printed (docs/theory, section 2.3).

#include <functional>
#include <vector>

#include "elastogear/model/check.h"
#include "elastogear/reduction/completeness.h"
#include "reduction/modes/effective_mass.h"

namespace elastogear::reduction {

/// Effective modal masses: tables `effective_mass`, `effective_inertia` (a row per mode) and `captured_mass`
/// (their sums as shares of what all modes carry together and of the whole body). Of a free body, whose modes
/// carry none, instead `rigid_coupling`: the largest |C_l| / sqrt(m) and, about the centre of mass,
/// |C_r| / sqrt(J), which ought to be roundoff. mobile: finds mobile_masses of a body that is held.
/// Collective; body is read on rank 0, where the result is.
std::vector<model::Check> mass_checks(bool floating, const model::ElasticBody& body,
                                      const std::function<SixDirections()>& mobile);

/// Table `static_completeness`. Collective.
std::vector<model::Check> load_checks(const ElasticSystem& system, const model::ElasticBody& body,
                                      int n_nodes);

/// Table `ritz_residual`: how far each vector of a Ritz basis is from an eigenmode.
model::Check ritz_check(const Eigen::VectorXd& residual);

}  // namespace elastogear::reduction
