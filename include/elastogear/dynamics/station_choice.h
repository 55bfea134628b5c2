#pragma once
// Which pairs of bodies touch at stations: docs/theory, section 6.18.

#include <string>

#include "elastogear/dynamics/system_model.h"

namespace elastogear::dynamics {

/// What a pair lacks for contact at stations: charts of exact flanks, static responses and one elastic
/// material at the surface of one body at least, the other one being rigid or the same, no penalty and no
/// friction that sticks. Empty: nothing.
std::string lacks_for_stations(const SystemModel& model, const PairSetup& pair);

inline constexpr int kStrips = 16;  ///< of a pair of teeth, over the face
/// Strips on which stations of a pair stand; 0: it has none, or points that move along the face.
int strips_of(const SystemModel& model, const PairSetup& pair);

}  // namespace elastogear::dynamics
