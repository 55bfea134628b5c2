#pragma once
// Static motion of markers under forces on the contact surface (docs/theory.md, Eq. (3.16a)).

#include "reduction/reduce_job.h"

namespace elastogear::reduction {

/// Sets the static responses F of the markers of the job's body, whose flexibility is known. whole: the whole
/// body; null for a held one that repeats around its axis. Collective.
void add_marker_responses(Job& job, const ElasticSystem* whole);

}  // namespace elastogear::reduction
