#pragma once
// Gmsh's element types (reference manual, section "Node ordering"), and what our own .msh files are known by.

#include <array>
#include <optional>
#include <span>
#include <string_view>

#include "elastogear/mesh/mesh.h"

namespace elastogear::mesh::msh_format {

struct ElementType {
  int number;
  int dim;
  int n_nodes;
  const char* plural;
  std::optional<CellType> cell = std::nullopt;
};

/// The section behind the format.
constexpr std::string_view kSignature = "$Comments\nelastogear mesh, in m\n$EndComments\n";

constexpr int kPoint = 15, kTriangle = 2, kQuadrangle = 3;

/// All that are read; lines are left out and reported.
constexpr ElementType kTypes[] = {{kPoint, 0, 1, "points"},
                                  {1, 1, 2, "lines"},
                                  {8, 1, 3, "second-order lines"},
                                  {kTriangle, 2, 3, "triangles"},
                                  {kQuadrangle, 2, 4, "quadrangles"},
                                  {9, 2, 6, "second-order triangles"},
                                  {16, 2, 8, "second-order quadrangles"},
                                  {4, 3, 4, "tetrahedra", CellType::tet4},
                                  {5, 3, 8, "hexahedra", CellType::hex8},
                                  {6, 3, 6, "prisms", CellType::wedge6},
                                  {7, 3, 5, "pyramids", CellType::pyramid5},
                                  {11, 3, 10, "second-order tetrahedra", CellType::tet10},
                                  {17, 3, 20, "second-order hexahedra", CellType::hex20},
                                  {18, 3, 15, "second-order prisms", CellType::wedge15}};

/// Gmsh's position of each of our nodes; empty where the orders are the same. Gmsh sorts the edges of
/// second-order cells by their first corner, Abaqus goes round the bottom, round the top, then up.
inline std::span<const int> gmsh_position(CellType type) {
  static constexpr std::array kTet10{0, 1, 2, 3, 4, 5, 6, 7, 9, 8};
  static constexpr std::array kHex20{0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15};
  static constexpr std::array kWedge15{0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11};
  if (type == CellType::tet10) return kTet10;
  if (type == CellType::hex20) return kHex20;
  if (type == CellType::wedge15) return kWedge15;
  return {};
}

}  // namespace elastogear::mesh::msh_format
