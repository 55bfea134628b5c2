#pragma once
// Which pairs of bodies touch at stations, and which have the local approach of flanks by H. Hertz:
// docs/theory, sections 6.18 and 6.17.

#include <string>

#include "elastogear/dynamics/system_model.h"

namespace elastogear::dynamics {

/// What a pair lacks for contact at stations (section 6.18): charts of involute flanks on parallel axes,
/// static responses and one elastic material at the surface of both bodies, no friction that sticks and no
/// choice of an approach. Empty: nothing.
std::string lacks_for_stations(const SystemModel& model, const PairSetup& pair);

/// What a pair, with its law and points chosen, lacks for the approach by H. Hertz: points of least gap
/// without a penalty, exact flanks, residual flexibility and one elastic material at the surface of both
/// bodies. Empty: nothing.
std::string lacks_for_approach(const SystemModel& model, const PairSetup& pair);

/// What contact::FlankApproach::automatic stands for: hertz where nothing lacks for it, the mesh's elsewhere.
/// Throws Error where hertz is asked for and something does.
contact::FlankApproach chosen_approach(const SystemModel& model, const PairSetup& pair);

}  // namespace elastogear::dynamics
