#pragma once
// *BOUNDARY of an Abaqus input file, as a restraint of whole nodes.

#include <string>
#include <vector>

#include "elastogear/mesh/file.h"
#include "inp_lines.h"
#include "inp_sets.h"

namespace elastogear::mesh {

struct BoundaryLine {
  std::string members;  // node number or set
  int directions = 0;   // bit k: direction k is held
  int line = 0;
};

/// What a data line holds; displacements other than 0 and conditions of no displacement go to `ignored`.
void read_boundary(InpLines& in, const Keyword& key, std::vector<BoundaryLine>& boundary,
                   std::vector<std::string>& ignored);

/// Makes a node set of all held nodes and names it in the report; when a node is held in some directions
/// only, says so there instead. Error for unknown nodes and sets.
void apply_boundary(const InpLines& in, const std::vector<BoundaryLine>& boundary, const InpSets& node_sets,
                    const TagTable& nodes, Mesh& mesh, ReadReport& report);

}  // namespace elastogear::mesh
