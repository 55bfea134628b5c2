#pragma once
// F and G of a cyclically symmetric body, a few columns at a time, from the responses of its harmonics.

#include <mpi.h>

#include <vector>

#include "elastogear/mesh/repetition.h"
#include "elastogear/reduction/flexibility.h"
#include "reduction/cyclic/responses/wanted_rows.h"

namespace elastogear::reduction {

/// Hands the columns of F and G to the sink, on rank 0, where those of all harmonics are put together. own:
/// of the harmonics of this rank, ascending; they are released with the columns that are done, so that never
/// many more numbers are in memory than at the beginning. plan: read on rank 0. The columns are the same to
/// the bit for any number of ranks. Collective; an error of the sink reaches all ranks.
void deliver_columns(MPI_Comm comm, const mesh::Turn& sectors, const WantedRows& wanted,
                     std::vector<Amplitudes>& own, const model::Flexibility& plan, const ColumnSink& sink);

}  // namespace elastogear::reduction
