#pragma once
// Steps of bodies in motion without a penalty: which points are held, and with what force (docs/theory,
// section 6.15).

#include <vector>

#include "contact/forces/history.h"

namespace elastogear::contact {

/// Gives the law of a point, complete but for these, its force or what it takes from the start of the step.
void set_given(const History& history, int point, Law& law);
/// Holds the points that carry a force, and those that come to be entered.
void begin_step(History& history, const ImpactStep& step);
/// Updates the active set of points, at the end of a step. contacts: that
/// solve it with the points held so far. Returns whether anything has changed.
bool change_closed(Histories& histories, const std::vector<ContactPoint>& contacts);
/// Between two steps of an impact law: keeps gaps and rates, and takes the points without a force out.
void keep_gaps(Histories& histories, std::vector<ContactPoint>& contacts);
/// Has there been an impulse in the step: do points that bore no force before have a share in the forces
/// given last that counts? Then `delivered` of it is left.
bool take_impulse(Histories& histories, double delivered);

}  // namespace elastogear::contact
