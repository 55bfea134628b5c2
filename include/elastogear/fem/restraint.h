#pragma once
// Restrained displacements: of nodes in all directions or in some.

#include <string>
#include <vector>

#include "elastogear/mesh/hold.h"
#include "elastogear/mesh/mesh.h"

namespace elastogear::fem {

/// Returns for each node the directions in which it has no displacement: those in which one of the sets holds
/// it ("bore", "symmetry:z", see mesh/hold.h), and all where it belongs to no cell. Throws Error for an
/// unknown set.
std::vector<mesh::Directions> held_directions(const mesh::Mesh& mesh,
                                              const std::vector<std::string>& restrain);

/// One flag per node: true when the node has a displacement.
std::vector<bool> free_nodes(const std::vector<mesh::Directions>& held);
std::vector<bool> free_nodes(const mesh::Mesh& mesh, const std::vector<std::string>& restrain);

/// Numbers 3 node + direction of the free displacements, ascending.
std::vector<int> free_dofs(const std::vector<mesh::Directions>& held);

/// The directions in which each of n_nodes nodes is held when these are the numbers of the free
/// displacements.
std::vector<mesh::Directions> held_directions(const std::vector<int>& free_dof, int n_nodes);

/// Throws Error unless every connected part of the mesh is held against all six rigid motions: naming a node
/// of the part and the motions that are left to it. (Hinges inside a part are found by the factorisation.)
void require_held(const mesh::Mesh& mesh, const std::vector<mesh::Directions>& held);

/// Throws Error naming the number of parts unless all cells hang together: what a free body must do. (Parts
/// that touch in an edge or a node only are found by their zero eigenvalues.)
void require_connected(const mesh::Mesh& mesh);

}  // namespace elastogear::fem
