#pragma once
// Penalty stiffness of a pair and of its slave nodes; checks of what the user gave.

#include "elastogear/contact/law.h"
#include "elastogear/contact/pair.h"

namespace elastogear::contact {

/// Throws Error naming the setting and what is allowed.
void validate(const Settings& settings);

void validate(const FrictionSettings& settings);

/// Throws Error naming surface a (0) or b (1).
void validate(const model::Surface& surface, int side);
void validate(const SurfaceState& state, const model::Surface& surface, int side);
void validate(const SurfaceMotion& motion, const model::Surface& surface, int side);

/// Fills in what is 0. Stiffness: mean c_f of both sides in series, per node times the mean area of a slave
/// node; one value for the whole pair, so that forces derive from a potential. Depth: half the smaller face
/// size, skin: a quarter of it. Throws Error when c_f is needed and not positive. docs/theory.md, Eq. (6.6).
Settings with_defaults(Settings settings, const model::Surface& a, const model::Surface& b);

/// N/m per node of the slave surface, settings complete.
Eigen::VectorXd node_stiffness(const Settings& settings, const model::Surface& slave);

/// The law of each node of the slave surface, settings complete.
std::vector<Law> node_laws(const Settings& settings, const model::Surface& slave);

/// No more than the penalty on facets.
bool has_potential(const Settings& settings);

}  // namespace elastogear::contact
