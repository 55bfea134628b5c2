#pragma once
// *BOUNDARY of an Abaqus input file, as a restraint.

#include <string>
#include <vector>

#include "elastogear/mesh/file.h"
#include "mesh/inp/cards/transform.h"
#include "mesh/inp/lines/inp_notes.h"

namespace elastogear::mesh {

struct BoundaryLine {
  std::string members;  // node number or set
  int directions = 0;   // bit k: direction k is held
  int line = 0;
};

/// Reads the data lines of a *BOUNDARY; displacements other than 0 and conditions of no displacement go to
/// `notes`.
void read_boundary(InpLines& in, const Keyword& key, std::vector<BoundaryLine>& boundary, InpNotes& notes);

/// The directions in which each node is held. Error for unknown nodes and sets.
std::vector<Directions> held_nodes(const InpLines& in, const std::vector<BoundaryLine>& boundary,
                                   const InpSets& node_sets, const TagTable& nodes, const Mesh& mesh);

/// The name, with as many '_' as no set of nodes or faces has.
std::string unused_name(const Mesh& mesh, std::string name);

/// Makes node sets of the held nodes, one for each combination of directions, and names them in the report.
void make_restraint(const std::vector<Directions>& held, Mesh& mesh, ReadReport& report);

}  // namespace elastogear::mesh
