#pragma once
// Task of a Ritz basis: the loaded faces of a reduction in terms of its matrices' rows.

#include "elastogear/reduction/completeness.h"
#include "reduction/bases/ritz_bases.h"
#include "reduction/job/reduce_job.h"

namespace elastogear::reduction {

/// The task that job.options.ritz sets, in the order of rows of the system's matrices. Collective.
RitzTask ritz_task(Job& job, const ElasticSystem& system, const EigenOptions& eigen);

}  // namespace elastogear::reduction
