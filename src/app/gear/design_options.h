#pragma once
// Options of the gear data, which `mesh` makes bodies of and `simulate` takes exact flanks from.

#include "app/gear/drive.h"
#include "app/options/rows.h"
#include "elastogear/gear/design.h"
#include "elastogear/gear/wheel.h"
#include "elastogear/gear/worm.h"

namespace elastogear::app {

/// The rows of a gear::Design, with part, size, element_order, refinement and mesh, which are read elsewhere.
const Rows<gear::Design>& design_rows();

/// The option element_order: 1 or 2.
int element_order(const Options& options);
/// The options size, element_order and refinement.
MeshDensity mesh_density(const Options& options);

/// Counts of cells in the meshes of worm and wheel; the default ones are those of the size.
const Rows<gear::WormCounts>& worm_count_rows();
const Rows<gear::WheelCounts>& wheel_count_rows();
/// Throws Error when counts are given: a drive's meshes follow from size.
void refuse_counts(const Options& options);

/// Which of the two bodies is the option part?
bool is_worm(const Options& options);

}  // namespace elastogear::app
