#pragma once
// The contact surface of a body: which faces, which nodes, which group, how stiff.

#include <string>
#include <vector>

#include "elastogear/mesh/mesh.h"
#include "elastogear/model/elastic_body.h"
#include "elastogear/model/material.h"

namespace elastogear::reduction {

/// Union of the named face sets, every face once and turned outward; Phi stays empty.
///
/// Groups ("areas of contact"): a face belongs to the *smallest* face set of the whole mesh that contains it,
/// named in face_sets or not; of sets of one size the alphabetically first. So `flanks`, the union of all
/// teeth's flanks, gives the groups tooth_01_left, tooth_01_right, ... by itself. Groups are in alphabetical
/// order.
///
/// c_f = E A / V of the cell behind each face (A: the face's area, V: the cell's volume): the stiffness per
/// area of a bar from the face through the cell.
///
/// Throws Error for an unknown set and for a face that is not on the mesh's boundary.
model::Surface make_surface(const mesh::Mesh& mesh, const std::vector<model::MaterialRegion>& regions,
                            const std::vector<std::string>& face_sets);

}  // namespace elastogear::reduction
