#pragma once
// How near to each other the points of two surfaces must be to be looked at.

#include <array>

#include "contact/projection/heights.h"
#include "contact/search/tracker.h"

namespace elastogear::contact {

struct Reach {
  Limits limits;
  double gap = 0;  ///< m, of open candidates of the unilateral law
  double sag = 0;  ///< m, of gaps within faces below those at their nearest nodes
};

/// settings: complete. heights: over the faces of each surface.
Reach reach_of(const Settings& settings, const std::array<const Tracked*, 2>& tracked,
               const std::array<const Heights*, 2>& heights);

}  // namespace elastogear::contact
