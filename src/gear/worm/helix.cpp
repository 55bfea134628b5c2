#include "gear/worm/helix.h"

#include "gear/assembly.h"

namespace elastogear::gear {

int Helix::top(int j) const { return top_0 - floor_div(j, m); }

int Helix::bottom(int j) const { return -top(-j - 1); }

HelixNode canonical(const Helix& h, HelixNode node) {
  const auto [k, j] = node;
  const int turns = floor_div(j, h.turn());
  if (turns != 0) return canonical(h, {k + turns * h.K, j - turns * h.turn()});
  if (j % h.m == 0 && k == h.top(j) + 1) return canonical(h, {k - 1, j + 1});
  if (j % h.m == 0 && -k == h.top(-j) + 1) return canonical(h, {k + 1, j - 1});
  return node;
}

NodeKind kind(const Helix& h, HelixNode node) {
  if (node.k != h.top(node.j)) return NodeKind::inner;
  return node.j % h.m == 0 ? NodeKind::step : NodeKind::rim;
}

std::vector<HelixNode> treads(const Helix& h) {
  std::vector<HelixNode> begins;
  for (int j = 0; j < h.turn(); ++j)
    if (j % h.m != 0) begins.push_back(canonical(h, {h.top(j), j}));
  return begins;
}

}  // namespace elastogear::gear
