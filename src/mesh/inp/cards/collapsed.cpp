#include "mesh/inp/cards/collapsed.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "elastogear/base/sort_unique.h"

namespace elastogear::mesh {
namespace {

using Ring = std::vector<Tag>;  // corners of a face in order, counter-clockwise seen from outside

std::vector<std::vector<int>> side_positions(CellType type) {
  std::vector<int> position(static_cast<std::size_t>(node_count(type)));
  std::iota(position.begin(), position.end(), 0);
  return cell_side_nodes(type, position);
}

bool is_second_order(CellType type) { return node_count(type) > corner_count(type); }

// What is left of the element's sides: triangles and quadrangles; nothing when one of them is folded.
std::optional<std::vector<Ring>> rings(const CellNodes& cell) {
  std::vector<Ring> found;
  for (int side = 0; side < side_count(cell.type); ++side) {
    const Ring ring = different_corners(cell, side);
    Ring sorted = ring;
    sort_unique(sorted);
    if (sorted.size() < ring.size()) return std::nullopt;
    if (ring.size() > 2) found.push_back(ring);
  }
  return found;
}

// Triangles, quadrangles and corners tell the type.
std::optional<CellType> type_of(const std::vector<Ring>& rings, std::size_t n_corners) {
  const auto n_triangles =
      std::count_if(rings.begin(), rings.end(), [](const Ring& r) { return r.size() == 3; });
  const auto n_quads = std::ssize(rings) - n_triangles;
  if (n_corners == 4 && n_triangles == 4 && n_quads == 0) return CellType::tet4;
  if (n_corners == 5 && n_triangles == 4 && n_quads == 1) return CellType::pyramid5;
  if (n_corners == 6 && n_triangles == 2 && n_quads == 3) return CellType::wedge6;
  return std::nullopt;
}

bool contains(const Ring& ring, Tag node) { return std::find(ring.begin(), ring.end(), node) != ring.end(); }

bool is_edge(const Ring& ring, Tag a, Tag b) {
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Tag p = ring[i], q = ring[(i + 1) % ring.size()];
    if ((p == a && q == b) || (p == b && q == a)) return true;
  }
  return false;
}

// Corners: the bottom, seen from inside, then what stands above it.
std::vector<Tag> corners_in_order(CellType type, const std::vector<Ring>& rings,
                                  const std::vector<Tag>& all) {
  const std::size_t bottom_size = type == CellType::pyramid5 ? 4 : 3;
  const Ring& bottom =
      *std::find_if(rings.begin(), rings.end(), [&](const Ring& r) { return r.size() == bottom_size; });
  std::vector<Tag> corners(bottom.rbegin(), bottom.rend());
  for (std::size_t i = 0; i < (type == CellType::wedge6 ? 3u : 1u); ++i)
    for (Tag node : all)
      if (!contains(bottom, node) && std::any_of(rings.begin(), rings.end(), [&](const Ring& r) {
            return is_edge(r, corners[i], node);
          })) {
        corners.push_back(node);
        break;
      }
  return corners;
}

// Adds the nodes in the middles of the edges of the linear cell; false where they are not those of the
// element.
bool add_midside_nodes(const CellNodes& element, CellNodes& cell) {
  std::map<std::pair<Tag, Tag>, Tag> middle;
  const auto edges_of = edges(element.type);
  const auto n_corners = static_cast<std::size_t>(corner_count(element.type));
  for (std::size_t e = 0; e < edges_of.size(); ++e) {
    const auto ends = std::minmax(element.nodes[edges_of[e][0]], element.nodes[edges_of[e][1]]);
    const Tag node = element.nodes[n_corners + e];
    if (ends.first != ends.second &&
        middle.try_emplace({ends.first, ends.second}, node).first->second != node)
      return false;
  }
  if (cell.type == CellType::pyramid5) return false;
  cell.type = cell.type == CellType::tet4 ? CellType::tet10 : CellType::wedge15;
  for (const auto& [a, b] : edges(cell.type)) {
    const auto ends = std::minmax(cell.nodes[a], cell.nodes[b]);
    const auto found = middle.find({ends.first, ends.second});
    if (found == middle.end()) return false;
    cell.nodes.push_back(found->second);
  }
  return true;
}

}  // namespace

int side_count(CellType type) { return static_cast<int>(side_positions(type).size()); }

std::vector<Tag> different_corners(const CellNodes& cell, int side) {
  const std::vector<int> positions = side_positions(cell.type)[static_cast<std::size_t>(side)];
  const std::size_t n = is_second_order(cell.type) ? positions.size() / 2 : positions.size();
  std::vector<Tag> corners;
  for (std::size_t i = 0; i < n; ++i)
    if (const Tag node = cell.nodes[positions[i]]; corners.empty() || corners.back() != node)
      corners.push_back(node);
  while (corners.size() > 1 && corners.back() == corners.front()) corners.pop_back();
  return corners;
}

std::optional<CellNodes> without_repeated_nodes(CellType type, std::span<const Tag> nodes) {
  const CellNodes element{type, {nodes.begin(), nodes.end()}};
  std::vector<Tag> corners(nodes.begin(), nodes.begin() + corner_count(type));
  sort_unique(corners);
  const auto faces = rings(element);
  const auto linear = faces ? type_of(*faces, corners.size()) : std::nullopt;
  if (!linear) return std::nullopt;
  CellNodes cell{*linear, corners_in_order(*linear, *faces, corners)};
  if (static_cast<int>(cell.nodes.size()) != node_count(*linear)) return std::nullopt;
  if (is_second_order(type) && !add_midside_nodes(element, cell)) return std::nullopt;
  return cell;
}

}  // namespace elastogear::mesh
