#include "contact/projection/edges.h"

#include <Eigen/Geometry>
#include <cmath>

namespace elastogear::contact {
namespace {

struct Middle {
  Eigen::Vector3d x, n;  // m, unit normal
};

Middle middle(const SurfaceView& surface, int f) {
  const Face face = face_of(surface, f);
  const Eigen::Vector2d at = face.sides == 4 ? Eigen::Vector2d(0, 0) : Eigen::Vector2d(1. / 3, 1. / 3);
  return {combine(face, shape(face.sides, at[0], at[1]).N), normal(face, at[0], at[1])};
}

// An edge of two faces of which each lies behind the plane of the other.
bool is_ridge(const SurfaceView& surface, std::span<const int> sides, double cos_angle) {
  if (sides.size() != 2) return false;
  const Middle a = middle(surface, sides[0] / 4), b = middle(surface, sides[1] / 4);
  return a.n.dot(b.n) < cos_angle && a.n.dot(b.x - a.x) < 0;
}

}  // namespace

bool is_at_open_side(const SurfaceView& surface, int face, const Eigen::Vector4d& N) {
  constexpr double kBeside = 0.05;
  const int sides = side_count(surface.face, face);
  for (int side = 0; side < sides; ++side)
    if (surface.topology.is_open(face, side) && N[side] + N[(side + 1) % sides] > 1 - kBeside) return true;
  return false;
}

std::vector<bool> boundary_nodes(const SurfaceView& surface) {
  std::vector<bool> marked(static_cast<std::size_t>(surface.x.cols()), false);
  for (int f : surface.topology.open_faces)
    for (int side = 0, sides = side_count(surface.face, f); side < sides; ++side)
      if (surface.topology.is_open(f, side))
        marked[surface.face(side, f)] = marked[surface.face((side + 1) % sides, f)] = true;
  return marked;
}

std::vector<bool> edge_nodes(const SurfaceView& surface, double feature_angle) {
  std::vector<bool> marked = boundary_nodes(surface);
  const Rows& edges = surface.topology.edge_sides;
  for (int e = 0; e < edges.size(); ++e) {
    if (!is_ridge(surface, edges[e], std::cos(feature_angle))) continue;
    const int f = edges[e][0] / 4, side = edges[e][0] % 4;
    marked[surface.face(side, f)] = marked[surface.face((side + 1) % side_count(surface.face, f), f)] = true;
  }
  return marked;
}

int face_beyond(const Topology& topology, int face, int side) {
  const int edge = topology.edge(side, face);
  if (edge < 0 || topology.edge_sides[edge].size() != 2) return -1;
  const auto both = topology.edge_sides[edge];
  return (both[0] / 4 == face ? both[1] : both[0]) / 4;
}

int face_opposite(const SurfaceView& surface, int face, int corner, const std::array<int, 2>& beyond_sides) {
  const auto around = surface.topology.node_corners[surface.face(corner, face)];
  if (around.size() != 4) return -1;
  for (int entry : around)
    if (const int f = entry / 4; f != face && f != beyond_sides[0] && f != beyond_sides[1]) return f;
  return -1;
}

}  // namespace elastogear::contact
