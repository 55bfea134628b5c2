#pragma once
// Restrained nodes: all three displacements of a node in a restrained set are zero.

#include <string>
#include <vector>

#include "elastogear/mesh/mesh.h"

namespace elastogear::fem {

/// One flag per node: true when the node has displacements, i.e. is in no restrained node set and belongs to
/// a cell. Throws Error for an unknown set.
std::vector<bool> free_nodes(const mesh::Mesh& mesh, const std::vector<std::string>& restrained_sets);

/// Numbers 3 node + direction of the displacements of the free nodes, ascending.
std::vector<int> free_dofs(const std::vector<bool>& is_free);

/// Throws Error unless every connected part of the mesh is held against all six rigid motions, i.e. has three
/// restrained nodes that are not on one line. (Hinges inside a part are found by the factorisation.)
void require_held(const mesh::Mesh& mesh, const std::vector<bool>& is_free);

/// Throws Error naming the number of parts unless all cells hang together: what a free body must do. (Parts
/// that touch in an edge or a node only are found by their zero eigenvalues.)
void require_connected(const mesh::Mesh& mesh);

}  // namespace elastogear::fem
