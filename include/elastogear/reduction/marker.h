#pragma once
// Markers: node sets or face sets whose mean motion loads, bushings and sensors use (docs/theory,
// section 3.4).

#include <string>
#include <vector>

#include "elastogear/mesh/mesh.h"
#include "elastogear/model/elastic_body.h"

namespace elastogear::reduction {

/// One marker for each set, of that name, and one for a pressure behind it where the set is one of outer
/// faces; Phi stays empty. Nodes weigh by integrals of shape functions over the outer sides whose nodes all
/// belong to the set where these hold all of its nodes, else the same. Throws Error for an unknown, empty or
/// repeated set, and for one that is named as the body frame.
std::vector<model::Marker> make_markers(const mesh::Mesh& mesh, const std::vector<std::string>& sets);

/// From the displacements of all nodes to mean displacement and mean small rotation of each set, and to the
/// volume that its faces sweep, Eq. (3.18a), in the first row of a pressure: 6 n_markers x 3 n_nodes. The
/// rotation's rows are zero where the set lies on one line. Eq. (3.16).
model::SparseRows marker_operator(const mesh::Mesh& mesh, const std::vector<std::string>& sets);

}  // namespace elastogear::reduction
