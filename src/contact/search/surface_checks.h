#pragma once
// Checks of the surfaces of a pair, of their states and of their motions.

#include "elastogear/contact/types.h"

namespace elastogear::contact {

/// Throws Error naming surface a (0) or b (1).
void validate(const model::Surface& surface, int side);
void validate(const SurfaceState& state, const model::Surface& surface, int side);
void validate(const SurfaceMotion& motion, const model::Surface& surface, int side);

}  // namespace elastogear::contact
