#pragma once
// The nodes that a name means: a node set, or a face set for the nodes of its faces.

#include <string>
#include <vector>

#include "elastogear/mesh/mesh.h"

namespace elastogear::mesh {

struct NamedNodes {
  std::vector<int> node;   ///< ascending
  bool of_faces = false;   ///< of the face set; else of the node set
  int other_of_faces = 0;  ///< nodes of a face set that has the name too and was not taken; 0: none, or the
                           ///< same nodes
};

/// A node set goes before a face set of the same name. Throws Error listing both kinds when there is neither.
NamedNodes named_nodes(const Mesh& mesh, const std::string& name);

/// Is there a node set or a face set of this name?
bool names_nodes(const Mesh& mesh, const std::string& name);

}  // namespace elastogear::mesh
