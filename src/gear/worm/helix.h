#pragma once
// The worm's grid on a cylinder: helical layers that end in plain columns (see worm.h).
//
// A node is (k, j): layer k on the axial line j = 0 .. turn - 1. Unrolled, it lies at the angle 2 pi j/turn
// and at the height k + j/m in units of a layer, m = turn/K sections per layer; so (k, j + turn) is the node
// (k + K, j). At the upper end the cells of column [j, j+1] fill the layers below top(j) = top - floor(j/m):
// a flat staircase of K steps. At each step, j a multiple of m, the riser from (top(j), j) to (top(j) + 1, j)
// is one edge with the tread from (top(j), j) to (top(j), j + 1), so turn - K tread edges remain, on which
// the shaft's columns stand. The lower end is the upper one turned by pi about the axis through (0, 0): (k,
// j) -> (-k, -j).

#include <vector>

namespace elastogear::gear {

struct HelixNode {
  int k = 0, j = 0;
  auto operator<=>(const HelixNode&) const = default;
};

struct Helix {
  int K = 0;      ///< layers that one turn rises
  int m = 0;      ///< sections per layer
  int top_0 = 0;  ///< layers above the middle in column 0

  int turn() const { return K * m; }
  int top(int j) const;     ///< end of the layers of cells in column [j, j + 1]
  int bottom(int j) const;  ///< begin
};

enum class NodeKind { inner, step, rim };

/// The one name of a node that has several: 0 <= j < turn, on the tread where riser and tread are joined.
HelixNode canonical(const Helix& helix, HelixNode node);

/// Kind of a canonical node. `step`: the foot of a step of the upper end (three cells meet there); `rim`: on
/// the treads that carry the upper shaft; `inner`: all others, those of the lower end included.
NodeKind kind(const Helix& helix, HelixNode node);

/// Begins of the tread edges that carry the upper shaft's columns, in the order of the angle; turn - K of
/// them.
std::vector<HelixNode> treads(const Helix& helix);

}  // namespace elastogear::gear
