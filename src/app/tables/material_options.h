#pragma once
// The options that describe materials, and the same from a mesh file when there are none.

#include <mpi.h>

#include <vector>

#include "app/options/options.h"
#include "elastogear/model/material.h"

namespace elastogear::app {

/// Rows for the options of all cells that no set names (material_E) and of one cell set (material_<set>_E).
OptionTable material_table();

/// The regions that options give; empty when none does. Error for a material given in part.
std::vector<model::MaterialRegion> material_options(const Options& options);

/// Gives the regions of rank 0 to all ranks. Collective.
void broadcast(MPI_Comm comm, std::vector<model::MaterialRegion>& regions);

}  // namespace elastogear::app
