#pragma once
// Markers: node sets or face sets whose mean motion loads, bushings and sensors use (docs/theory,
// section 3.4).

#include <string>
#include <vector>

#include "elastogear/mesh/mesh.h"
#include "elastogear/model/elastic_body.h"

namespace elastogear::reduction {

/// Weight of a node in the mean of its set: equal for all nodes, or by integrals of shape functions over the
/// area of those outer sides whose nodes all belong to the set.
enum class MarkerWeights { equal, area };

/// One marker for each set, of that name; Phi stays empty. Throws Error for an unknown, empty or
/// repeated set, for one that is named as the body frame, and for one that has no area when that is to weigh.
std::vector<model::Marker> make_markers(const mesh::Mesh& mesh, const std::vector<std::string>& sets,
                                        MarkerWeights weights = MarkerWeights::equal);

/// From the displacements of all nodes to mean displacement and mean small rotation of each set:
/// 6 n_markers x 3 n_nodes. The rotation's rows are zero where the set lies on one line. Eq. (3.16).
model::SparseRows marker_operator(const mesh::Mesh& mesh, const std::vector<std::string>& sets,
                                  MarkerWeights weights = MarkerWeights::equal);

}  // namespace elastogear::reduction
