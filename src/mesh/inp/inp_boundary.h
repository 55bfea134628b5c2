#pragma once
// *BOUNDARY of an Abaqus input file, as a restraint.

#include <string>
#include <vector>

#include "elastogear/mesh/file.h"
#include "mesh/inp/inp_lines.h"
#include "mesh/inp/inp_sets.h"

namespace elastogear::mesh {

struct BoundaryLine {
  std::string members;  // node number or set
  int directions = 0;   // bit k: direction k is held
  int line = 0;
};

/// Reads the data lines of a *BOUNDARY; displacements other than 0 and conditions of no displacement go to
/// `ignored`.
void read_boundary(InpLines& in, const Keyword& key, std::vector<BoundaryLine>& boundary,
                   std::vector<std::string>& ignored);

/// Makes node sets of the held nodes, one for each combination of directions, and names them in the report.
/// Error for unknown nodes and sets.
void apply_boundary(const InpLines& in, const std::vector<BoundaryLine>& boundary, const InpSets& node_sets,
                    const TagTable& nodes, Mesh& mesh, ReadReport& report);

}  // namespace elastogear::mesh
