#pragma once
// Finds surfaces that overlap more at the start than facets and tolerances explain.
//
// The search finds (1) penetrations of the nodes of either surface, searched twice a face size deep and by
// the same rule as contact itself, so that the far side of a tooth is not taken for one; no node is deeper
// than its distance from the nearest face, whichever way that faces; surfaces that cross, at any angle, have
// nodes at all small depths; (2) a part of one surface that lies wholly inside the other,
// when that other is closed (winding number). It does not find a part wholly inside the body of an open
// surface and further than the search depth from it.

#include <array>
#include <string>

#include "elastogear/contact/pair.h"
#include "elastogear/contact/true_surface.h"
#include "elastogear/contact/types.h"

namespace elastogear::contact {

struct InitialOverlap {
  double penetration = 0;  ///< m, largest (>= 0)
  double face_size = 0;    ///< m, the smaller of both surfaces
  int slave_side = 0;      ///< where it was found
  int slave_node = -1;     ///< local number; -1: nowhere
  int face = -1;           ///< master face; -1 when `enclosed`
  bool enclosed = false;   ///< the part of surface `slave_side` with node `slave_node` lies inside the other
};

/// Of the surfaces of a pair, with its settings.
InitialOverlap initial_overlap(const Pair& pair, const SurfaceState& state_a, const SurfaceState& state_b);
/// The same without a pair. known: of either surface, as for Pair.
InitialOverlap initial_overlap(const model::Surface& a, const model::Surface& b, const Settings& settings,
                               const SurfaceState& state_a, const SurfaceState& state_b,
                               const std::array<const TrueSurface*, 2>& known = {});

/// Throws Error naming `pair` when a part is enclosed or penetrates more than `allowed` face sizes.
void require_apart(const InitialOverlap& overlap, const std::string& pair, double allowed = 0.1);

}  // namespace elastogear::contact
