#pragma once
// The sets of nodes that options of reduce name: node sets, face sets, or single nodes by their numbers.

#include <cstdint>
#include <string>
#include <vector>

#include "elastogear/mesh/mesh.h"

namespace elastogear::app {

/// Makes a node set of the same name of each name that is a number and no set: the node that has it in the
/// mesh file. Throws Error naming the option and the number for a node that there is not.
/// numbers: of the file, ascending, one for each node.
void add_numbered_nodes(mesh::Mesh& mesh, const std::vector<std::int64_t>& numbers, const std::string& option,
                        const std::vector<std::string>& names);

/// The names of the sets in a restraint: "symmetry" of "symmetry:z".
std::vector<std::string> restrained_sets(const mesh::Mesh& mesh, const std::vector<std::string>& restrain);

/// Prints a line for each set that is held, in which directions and how many nodes it has.
void print_restraint(const mesh::Mesh& mesh, const std::vector<std::string>& restrain);

/// Prints a line for each name: which set it means and how many nodes that has; and a warning where a node
/// set and a face set of one name have different nodes. Unknown names are left to those who use them.
void print_named_sets(const mesh::Mesh& mesh, const std::string& what, const std::vector<std::string>& names);

}  // namespace elastogear::app
