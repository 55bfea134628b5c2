#pragma once
// How cells hang together: by the nodes that they share, and where they only lie in the same place.

#include <string>
#include <vector>

#include "elastogear/mesh/mesh.h"
#include "elastogear/mesh/read_report.h"

namespace elastogear::mesh {

/// For each node one node of its connected part: the same for all nodes that cells join, itself where it
/// belongs to no cell.
std::vector<int> connected_parts(const Mesh& mesh);

/// What is wrong with how cells hang together, as sentences with the numbers of the file.
struct JointFaults {
  std::string overlap;            ///< cells that fill the same place twice; or empty
  std::vector<std::string> open;  ///< faces that lie on each other unmerged, parts that share no node
};

/// Two cells overlap where they lie on the same side of a face. A face is that of its corners, and nodes
/// nearer than a hundredth of the shortest edge count as one place. Inverted cells are left out, for they lie
/// on the wrong side. report: of the file that the mesh was read from, for its numbers; without, ours.
JointFaults joint_faults(const Mesh& mesh, const ReadReport& report = {});

}  // namespace elastogear::mesh
