#pragma once
// Settings of a pair: checks, defaults, and the law of each node.

#include "contact/forces/law.h"
#include "elastogear/contact/types.h"

namespace elastogear::contact {

/// Throws Error naming the setting and what is allowed.
void validate(const Settings& settings);

void validate(const FrictionSettings& settings);

/// Fills in what is 0. Stiffness: that of contact/stiffness.h, one value for the whole pair, so that forces
/// derive from a potential. Depth: half the smaller face size, skin: a quarter of it. With slave
/// points `minima`, boundaries are met by points of their own: extensions are no more than roundoff. Throws
/// Error when a stiffness of the surface is needed and not positive.
Settings with_defaults(Settings settings, const model::Surface& a, const model::Surface& b);

/// The law of each node of the slave surface, settings complete.
std::vector<Law> node_laws(const Settings& settings, const model::Surface& slave);

/// No more than the penalty: on facets its forces derive from a potential.
bool has_potential(const Settings& settings);

}  // namespace elastogear::contact
