// Corners, edges and sides of the cell types, numbered as in Abaqus.
#include <algorithm>
#include <limits>

#include "elastogear/base/error.h"
#include "elastogear/mesh/mesh.h"

namespace elastogear::mesh {
namespace {

using Edge = std::array<int, 2>;

// Sides S1.. turned outward, a triangle repeats its third corner.
constexpr Face kHexSides[] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                              {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
constexpr Face kTetSides[] = {{0, 2, 1, 1}, {0, 1, 3, 3}, {1, 2, 3, 3}, {2, 0, 3, 3}};
constexpr Face kWedgeSides[] = {{0, 2, 1, 1}, {3, 4, 5, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}};
constexpr Face kPyramidSides[] = {{0, 3, 2, 1}, {0, 1, 4, 4}, {1, 2, 4, 4}, {2, 3, 4, 4}, {3, 0, 4, 4}};
constexpr Edge kHexEdges[] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
                              {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
constexpr Edge kTetEdges[] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
constexpr Edge kWedgeEdges[] = {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}};
constexpr Edge kPyramidEdges[] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}};

struct Topology {
  const char* name;
  int corners;
  bool quadratic;  // a midside node on every edge
  std::span<const Edge> edges;
  std::span<const Face> sides;
};

// Topology of the cell types, in the order of CellType.
constexpr Topology kTopology[kCellTypes] = {{"hex8", 8, false, kHexEdges, kHexSides},
                                            {"hex20", 8, true, kHexEdges, kHexSides},
                                            {"tet4", 4, false, kTetEdges, kTetSides},
                                            {"tet10", 4, true, kTetEdges, kTetSides},
                                            {"wedge6", 6, false, kWedgeEdges, kWedgeSides},
                                            {"wedge15", 6, true, kWedgeEdges, kWedgeSides},
                                            {"pyramid5", 5, false, kPyramidEdges, kPyramidSides}};

const Topology& topology(CellType type) {
  const int i = static_cast<int>(type);
  require(i < kCellTypes, "unknown cell type ", i, ", allowed are 0..", kCellTypes - 1);
  return kTopology[i];
}

bool is_triangle(const Face& face) { return face[2] == face[3]; }

int midside_node(const Topology& cell, int a, int b) {
  const auto joins = [&](const Edge& e) { return e == Edge{a, b} || e == Edge{b, a}; };
  return cell.corners +
         static_cast<int>(std::find_if(cell.edges.begin(), cell.edges.end(), joins) - cell.edges.begin());
}

std::vector<std::vector<int>> find_side_nodes(const Topology& cell) {
  std::vector<std::vector<int>> sides;
  for (const Face& side : cell.sides) {
    const int n = is_triangle(side) ? 3 : 4;
    std::vector<int>& nodes = sides.emplace_back(side.begin(), side.begin() + n);
    for (int i = 0; cell.quadratic && i < n; ++i)
      nodes.push_back(midside_node(cell, side[i], side[(i + 1) % n]));
  }
  return sides;
}

std::vector<std::vector<Face>> find_sides(const Topology& cell) {
  std::vector<std::vector<Face>> sides;
  for (const std::vector<int>& nodes : find_side_nodes(cell)) sides.push_back(side_faces(nodes));
  return sides;
}

// Sides in the cell's own node numbers.
const std::vector<std::vector<Face>>& local_sides(CellType type) {
  static const auto all = [] {
    std::array<std::vector<std::vector<Face>>, kCellTypes> sides;
    for (int i = 0; i < kCellTypes; ++i) sides[i] = find_sides(kTopology[i]);
    return sides;
  }();
  topology(type);
  return all[static_cast<int>(type)];
}

Face global(const Face& local, std::span<const int> nodes) {
  return {nodes[local[0]], nodes[local[1]], nodes[local[2]], nodes[local[3]]};
}

}  // namespace

const char* name(CellType type) { return topology(type).name; }

int corner_count(CellType type) { return topology(type).corners; }

int node_count(CellType type) {
  const Topology& cell = topology(type);
  return cell.corners + (cell.quadratic ? static_cast<int>(cell.edges.size()) : 0);
}

std::span<const std::array<int, 2>> edges(CellType type) { return topology(type).edges; }

Face face_key(Face face) {
  // A triangle's repeated node goes last, whichever it is.
  if (is_triangle(face)) face[3] = std::numeric_limits<int>::max();
  std::sort(face.begin(), face.end());
  return face;
}

bool same_direction(const Face& a, Face b) {
  const int corners = is_triangle(b) ? 3 : 4;
  for (int turn = 0; turn < corners; ++turn) {
    if (a == b) return true;
    std::rotate(b.begin(), b.begin() + 1, b.begin() + corners);
    if (corners == 3) b[3] = b[2];
  }
  return false;
}

std::vector<Face> side_faces(std::span<const int> s) {
  switch (s.size()) {
    case 3:
      return {{s[0], s[1], s[2], s[2]}};
    case 4:
      return {{s[0], s[1], s[2], s[3]}};
    case 6:
      return {{s[0], s[3], s[5], s[5]},
              {s[1], s[4], s[3], s[3]},
              {s[2], s[5], s[4], s[4]},
              {s[3], s[4], s[5], s[5]}};
    case 8:
      return {{s[0], s[4], s[7], s[7]},
              {s[1], s[5], s[4], s[4]},
              {s[2], s[6], s[5], s[5]},
              {s[3], s[7], s[6], s[6]},
              {s[4], s[5], s[6], s[7]}};
  }
  fail("a side of a cell has ", s.size(), " nodes, allowed are 3, 4, 6 and 8");
}

std::vector<std::vector<int>> cell_side_nodes(CellType type, std::span<const int> nodes) {
  std::vector<std::vector<int>> sides = find_side_nodes(topology(type));
  for (auto& side : sides)
    for (int& node : side) node = nodes[node];
  return sides;
}

std::vector<std::vector<Face>> cell_sides(CellType type, std::span<const int> nodes) {
  std::vector<std::vector<Face>> sides = local_sides(type);
  for (auto& side : sides)
    for (Face& face : side) face = global(face, nodes);
  return sides;
}

std::vector<Face> cell_faces(CellType type, std::span<const int> nodes) {
  const auto& sides = local_sides(type);
  std::vector<Face> faces;
  faces.reserve(sides.size() * sides.back().size());
  for (const auto& side : sides)
    for (const Face& face : side) faces.push_back(global(face, nodes));
  return faces;
}

}  // namespace elastogear::mesh
