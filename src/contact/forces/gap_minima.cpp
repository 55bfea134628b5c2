#include "contact/forces/gap_minima.h"

#include <algorithm>
#include <optional>

#include "contact/forces/hermite.h"
#include "contact/forces/least_gap.h"
#include "elastogear/base/sort_unique.h"

namespace elastogear::contact {
namespace {

using Eigen::Vector2d;

constexpr double kMisplaced = 0.5;  // of half a face, that the estimated place of a minimum may be off

const NodeGap* find(const std::map<int, NodeGap>& nodes, int node) {
  const auto at = nodes.find(node);
  return at == nodes.end() ? nullptr : &at->second;
}

SideGaps side_of(const GapField& field, int edge, const std::map<int, NodeGap>& nodes) {
  const int entry = field.slave.topology.edge_sides[edge][0];
  SideGaps side;
  side.point.face = entry / 4;
  side.side = entry % 4;
  side.sides = side_count(field.slave.face, side.point.face);
  side.point.number = static_cast<int>(field.slave.x.cols()) + edge;
  side.point.n_dir = 1;
  side.point.along.col(0) = on_side(side.sides, side.side, 1) - on_side(side.sides, side.side, 0);
  for (int end : {0, 1}) {
    const NodeGap* node = find(nodes, field.slave.face((side.side + end) % side.sides, side.point.face));
    if (!node) continue;
    const int corner = (side.side + end) % side.sides;
    const Eigen::Vector3d a =
        corner_tangents(field.slave, field.heights, side.point.face, corner) * side.point.along.col(0);
    side.length = a.norm();
    side.g[end] = node->g;
    side.slope[end] = node->n.dot(a);
  }
  return side;
}

// Returns whether a gap that is estimated to fall from `highest` to `estimate` (m) may be below the reach.
bool may_be_within(double estimate, double highest, double reach) {
  constexpr double kUncertain = 0.5;  // of the fall
  return estimate - kUncertain * (highest - estimate) < reach;
}

// Returns whether a convex gap has a minimum between the ends of a side that may lie below the reach.
bool may_have_minimum(const SideGaps& side, double reach) {
  if (side.g[0] == kNoGap && side.g[1] == kNoGap) return false;
  if (side.g[0] != kNoGap && side.slope[0] >= 0) return false;
  if (side.g[1] != kNoGap && side.slope[1] <= 0) return false;
  if (side.g[0] == kNoGap) return side.g[1] - side.slope[1] < reach;
  if (side.g[1] == kNoGap) return side.g[0] + side.slope[0] < reach;
  return may_be_within(least_of_cubic(side.g, side.slope).value, std::min(side.g[0], side.g[1]), reach);
}

// Gaps and slopes at the corners of a quadrilateral; -kNoGap where the gap is not known.
FaceCorners corners_of(const GapField& field, int f, const std::map<int, NodeGap>& nodes) {
  FaceCorners corners;
  corners.value.setConstant(-kNoGap);
  corners.slope.setZero();
  for (int c = 0; c < 4; ++c)
    if (const NodeGap* node = find(nodes, field.slave.face(c, f))) {
      corners.slope.col(c) = corner_tangents(field.slave, field.heights, f, c).transpose() * node->n;
      corners.value[c] = node->g;
    }
  return corners;
}

// Estimates the place of the least gap on a quadrilateral by the bicubic with the gaps and slopes of its
// corners. The start has no master face where the gap is beyond the reach, or least well beyond the sides of
// the face; there is none where a corner's gap is not known.
std::optional<FaceStart> estimate(const GapField& field, int f, const std::map<int, NodeGap>& nodes) {
  if (side_count(field.slave.face, f) != 4) return {};
  const FaceCorners corners = corners_of(field, f, nodes);
  FaceStart start;
  double nearest = kNoGap;
  bool all_known = true;
  for (int c = 0; c < 4; ++c) {
    const NodeGap* node = find(nodes, field.slave.face(c, f));
    all_known = all_known && node;
    if (node && node->g < nearest) nearest = node->g, start.face = node->nearest;
  }
  if (lower_bound(corners) > field.reach.gap) return FaceStart{};
  if (!all_known) return {};
  const LeastOnFace least = least_of_bicubic(corners);
  if (least.beyond > kMisplaced) return FaceStart{};
  start.g = least.value;
  start.at = least.at;
  return may_be_within(start.g, nearest, field.reach.gap) ? start : FaceStart{};
}

// The slave faces around these nodes, ascending, but for those over which no convex gap with the tangent
// planes at these nodes is within the reach, nor along their sides.
std::vector<int> faces_around(const GapField& field, const std::map<int, NodeGap>& nodes) {
  std::vector<int> faces;
  for (const auto& [node, gap] : nodes)
    for (int corner : field.slave.topology.node_corners[node]) faces.push_back(corner / 4);
  sort_unique(faces);
  std::erase_if(faces, [&](int f) {
    return side_count(field.slave.face, f) == 4 && lower_bound(corners_of(field, f, nodes)) > field.reach.gap;
  });
  return faces;
}

// Returns the corner of a face with the least gap among those that have one. A search begins there on
// triangles and where a corner is beyond the limits or the master's boundary.
FaceStart least_corner(const GapField& field, int f, const std::map<int, NodeGap>& nodes) {
  const int sides = side_count(field.slave.face, f);
  FaceStart start;
  for (int c = 0; c < sides; ++c)
    if (const NodeGap* node = find(nodes, field.slave.face(c, f)); node && node->g < start.g)
      start = {node->g, on_side(sides, c, 0), node->nearest};
  return start;
}

// Adds the gaps at the other corners of the faces, however large, where the master has a foot point for them.
void add_corners(const GapField& field, const std::vector<int>& faces, std::map<int, NodeGap>& nodes) {
  Limits any = field.reach.limits;
  any.outside = any.depth = kNoGap;
  for (int f : faces) {
    const FaceStart start = least_corner(field, f, nodes);
    for (int c = 0; c < side_count(field.slave.face, f) && start.face >= 0; ++c) {
      const int node = field.slave.face(c, f);
      if (nodes.contains(node)) continue;
      const Eigen::Vector3d x = field.slave.at(node);
      const auto w = walk_to_projection(field.master.surface, x, any, start.face);
      if (!w) continue;
      const PointGap over = point_gap(field.master, *w, x, field.offset);
      nodes[node] = {over.gap.g, over.gap.n, over.projection.face};
    }
  }
}

// Minima along the sides of these faces, by edge.
std::map<int, std::vector<Minimum>> minima_on_sides(const GapField& field, const std::vector<int>& faces,
                                                    const std::map<int, NodeGap>& nodes) {
  const Topology& topology = field.slave.topology;
  std::vector<int> edges;
  for (int f : faces)
    for (int side = 0; side < side_count(field.slave.face, f); ++side)
      if (topology.edge(side, f) >= 0 && (field.whole || topology.is_open(f, side)))
        edges.push_back(topology.edge(side, f));
  sort_unique(edges);
  std::map<int, std::vector<Minimum>> found;
  for (int edge : edges) {
    const SideGaps side = side_of(field, edge, nodes);
    if (!may_have_minimum(side, field.reach.gap)) continue;
    const int end = side.g[0] <= side.g[1] ? 0 : 1;
    const int start = find(nodes, field.slave.face((side.side + end) % side.sides, side.point.face))->nearest;
    if (auto minima = minima_on_side(field, side, start); !minima.empty()) found.emplace(edge, minima);
  }
  return found;
}

// (u, v) on a face of a point on its side that is given on the face beyond.
Vector2d on_face(const GapField& field, int f, int side, const Minimum& m) {
  const int first = field.slave.face(side, f);
  const Eigen::Vector4i corners = field.slave.face.col(m.point.face);
  double s = 0;
  for (int c = 0; c < side_count(field.slave.face, m.point.face); ++c)
    if (corners[c] != first) s += m.geometry.N[c];
  return on_side(side_count(field.slave.face, f), side, s);
}

bool is_nearer(const FaceStart& a, const FaceStart& b) { return a.g < b.g; }

// The minima on the sides of a face, the least first.
std::vector<FaceStart> places_on_sides(const GapField& field, int f,
                                       const std::map<int, std::vector<Minimum>>& on_sides) {
  std::vector<FaceStart> places;
  for (int side = 0; side < side_count(field.slave.face, f); ++side) {
    const auto minima = on_sides.find(field.slave.topology.edge(side, f));
    if (minima == on_sides.end()) continue;
    for (const Minimum& m : minima->second)
      places.push_back({m.open.gap.g, on_face(field, f, side, m), m.open.projection.face});
  }
  std::stable_sort(places.begin(), places.end(), is_nearer);
  return places;
}

// Starts of the search for the least gap within a face, to be tried one after the other: the estimated place,
// the minima on its sides and the corner with the least gap. There is none if its gap is beyond the reach.
std::vector<FaceStart> starts_within(const GapField& field, int f, const std::map<int, NodeGap>& nodes,
                                     std::vector<FaceStart> known) {
  if (const FaceStart corner = least_corner(field, f, nodes); corner.face >= 0)
    known.insert(std::upper_bound(known.begin(), known.end(), corner, is_nearer), corner);
  if (const auto estimated = estimate(field, f, nodes)) {
    if (estimated->face < 0) return {};
    known.insert(known.begin(), *estimated);
    return known;
  }
  if (known.empty() || known[0].g - sag(field.reach, field.slave_side, f, known[0].face) >= field.reach.gap)
    return {};
  return known;
}

}  // namespace

std::vector<Minimum> gap_minima(const GapField& field, std::map<int, NodeGap> nodes) {
  const std::vector<int> faces = faces_around(field, nodes);
  if (field.whole) add_corners(field, faces, nodes);
  const auto n_nodes = static_cast<int>(field.slave.x.cols());
  const Topology& topology = field.slave.topology;
  const std::map<int, std::vector<Minimum>> on_sides = minima_on_sides(field, faces, nodes);
  std::vector<Minimum> minima;
  const auto take = [&](const Minimum& m) {
    if (m.open.gap.g < field.reach.gap) minima.push_back(m);
  };
  for (const auto& [edge, all] : on_sides)
    for (const Minimum& m : all) take(m);
  for (int f : field.whole ? faces : std::vector<int>()) {
    const std::vector<FaceStart> sides = places_on_sides(field, f, on_sides);
    const std::vector<FaceStart> starts = starts_within(field, f, nodes, sides);
    if (starts.empty()) continue;
    SlavePoint point;
    point.number = n_nodes + topology.edge_sides.size() + f;
    point.face = f;
    point.n_dir = 2;
    for (const Minimum& m : minima_within(field, point, starts, sides.empty() ? kNoGap : sides.front().g))
      take(m);
  }
  return minima;
}

}  // namespace elastogear::contact
