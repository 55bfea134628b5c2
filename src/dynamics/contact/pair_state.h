#pragma once
// Contact points of one pair as results see them.

#include "elastogear/dynamics/system.h"
#include "elastogear/model/result.h"

namespace elastogear::dynamics {

/// Forces, figures and contacts of pair p, in all and by area of contact.
model::PairState pair_state(System& system, const State& x, std::size_t p);

}  // namespace elastogear::dynamics
