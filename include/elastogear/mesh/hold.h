#pragma once
// A body is held by sets of nodes, each in all directions or in some.

#include <cstdint>
#include <string>
#include <vector>

#include "elastogear/mesh/mesh.h"

namespace elastogear::mesh {

/// Directions in which a node is held: bits 0, 1, 2 stand for x, y, z.
using Directions = std::uint8_t;
inline constexpr Directions kAllDirections = 7;

inline bool holds(Directions held, int direction) { return (held >> direction & 1) != 0; }

/// "xz"
std::string direction_names(Directions directions);

/// A node set or face set (mesh/named_nodes.h) and the directions in which its nodes are held.
struct Hold {
  std::string set;
  Directions directions = kAllDirections;
};

/// "bore": in all directions; "symmetry:z", "left:xy": in these. A set of which the text is the whole name
/// goes before. Throws Error for directions other than x, y, z; whether there is such a set is not asked.
Hold parse_hold(const Mesh& mesh, const std::string& text);

/// The directions in which each node is held by one or several of these ("bore", "symmetry:z"). Throws Error
/// for unknown sets.
std::vector<Directions> held_by(const Mesh& mesh, const std::vector<std::string>& holds);

/// Is a node held in some directions only?
bool has_single_directions(const std::vector<Directions>& held);

}  // namespace elastogear::mesh
