#pragma once
// Elements with repeated nodes: hexahedra and wedges as which other programs write wedges, pyramids and
// tetrahedra.

#include <optional>
#include <span>
#include <vector>

#include "mesh/raw/raw_mesh.h"

namespace elastogear::mesh {

struct CellNodes {
  CellType type;
  std::vector<Tag> nodes;
};

/// The cell with the same faces that repeats no node; nothing where there is none.
std::optional<CellNodes> without_repeated_nodes(CellType type, std::span<const Tag> nodes);

/// The different corners of a side of such an element, in order.
std::vector<Tag> different_corners(const CellNodes& cell, int side);

/// Number of sides of a cell type.
int side_count(CellType type);

}  // namespace elastogear::mesh
