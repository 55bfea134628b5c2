#include "elastogear/contact/initial_overlap.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include "contact/projection/closest_point.h"
#include "elastogear/base/error.h"
#include "elastogear/base/sort_unique.h"
#include "elastogear/contact/topology.h"

namespace elastogear::contact {
namespace {

Eigen::Matrix3Xd in_world(const SurfaceState& state) {
  return (state.R_WB * state.x_B).colwise() + state.r_WB;
}

// Signed solid angle of a triangle seen from the origin (Van Oosterom & Strackee 1983).
double solid_angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

// 1 inside a closed surface, 0 outside.
double winding_number(const Eigen::Matrix3Xd& x, const Eigen::Matrix4Xi& face, const Eigen::Vector3d& q) {
  double sum = 0;
  for (int f = 0; f < face.cols(); ++f) {
    const Eigen::Matrix<double, 3, 4> c = x(Eigen::all, face.col(f)).colwise() - q;
    sum += solid_angle(c.col(0), c.col(1), c.col(2)) + solid_angle(c.col(0), c.col(2), c.col(3));
  }
  return sum / (4 * std::numbers::pi);
}

// One node of each connected part.
std::vector<int> part_nodes(const Eigen::Matrix4Xi& face, int n_nodes) {
  std::vector<int> parent(n_nodes);
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const auto& f : face.colwise())
    for (int i = 1; i < 4; ++i) parent[root(f[i])] = root(f[0]);
  std::vector<int> nodes;
  for (const auto& f : face.colwise())
    if (root(f[0]) == f[0]) nodes.push_back(f[0]);
  sort_unique(nodes);
  return nodes;
}

void find_enclosed(const model::Surface* surface[2], const SurfaceState* state[2], InitialOverlap& result) {
  for (int side = 0; side < 2 && !result.enclosed; ++side) {
    const model::Surface& inner = *surface[side];
    const model::Surface& outer = *surface[1 - side];
    if (!topology(outer.face, static_cast<int>(outer.X.cols())).open_faces.empty()) continue;
    const Eigen::Matrix3Xd x_inner = in_world(*state[side]), x_outer = in_world(*state[1 - side]);
    for (int node : part_nodes(inner.face, static_cast<int>(inner.X.cols())))
      if (std::abs(winding_number(x_outer, outer.face, x_inner.col(node))) > 0.5) {
        result.enclosed = true;
        result.slave_side = side;
        result.slave_node = node;
      }
  }
}

// How deep a node is inside the master, m, with which it is in contact at a face and as deep as said. Beside
// a corner, as of a tip, the nearest face may not oppose the node, and contact then takes one behind, on the
// far side of the body. Yet a node is no deeper inside than its nearest face is away, and it is not inside
// where it is in front of that, or beyond an end of the surface.
double depth_of(const SurfaceView& master, const Eigen::Vector3d& x, int face, double depth) {
  const ClosestPoint found = closest_point(face_of(master, face), x);
  ClosestPoint nearest = found;
  int of = face;
  for (int f = 0; f < master.face.cols(); ++f)
    if (const ClosestPoint p = closest_point(face_of(master, f), x); p.distance2 < nearest.distance2)
      nearest = p, of = f;
  if (of == face) return depth;
  const bool in_front = (x - nearest.x).dot(normal(face_of(master, of), nearest.u, nearest.v)) > 0;
  if (in_front || nearest.feature == Feature::outside) return 0;
  return depth - (std::sqrt(found.distance2) - std::sqrt(nearest.distance2));
}

}  // namespace

InitialOverlap initial_overlap(const Pair& pair, const SurfaceState& state_a, const SurfaceState& state_b) {
  const model::Surface &a = pair.surface(0), &b = pair.surface(1);
  const Settings& settings = pair.given();
  InitialOverlap result;
  result.face_size = std::min(face_size(a.X, a.face), face_size(b.X, b.face));
  Settings deep = settings;
  deep.two_pass = true;
  deep.points = SlavePoints::nodes;
  deep.k = 6;  // for one search trees that are built quickly are better than tight ones
  deep.depth = std::max(settings.depth, 2 * result.face_size);
  const std::array<Eigen::Matrix3Xd, 2> x = {in_world(state_a), in_world(state_b)};
  std::array<std::optional<Topology>, 2> known;
  for (const ContactPoint& contact : Pair(pair, deep).detect(state_a, state_b)) {
    if (-contact.g_n <= result.penetration) continue;
    const std::size_t slave = contact.slave_side, master = 1 - slave;
    const Eigen::Matrix4Xi& face = pair.surface(static_cast<int>(master)).face;
    if (!known[master]) known[master] = topology(face, static_cast<int>(x[master].cols()));
    const double penetration = depth_of({face, *known[master], x[master]}, x[slave].col(contact.slave_node),
                                        contact.face, -contact.g_n);
    if (penetration <= result.penetration) continue;
    result.penetration = penetration;
    result.slave_side = contact.slave_side;
    result.slave_node = contact.slave_node;
    result.face = contact.face;
  }
  const model::Surface* surface[2] = {&a, &b};
  const SurfaceState* state[2] = {&state_a, &state_b};
  if (result.slave_node < 0) find_enclosed(surface, state, result);
  return result;
}

InitialOverlap initial_overlap(const model::Surface& a, const model::Surface& b, const Settings& settings,
                               const SurfaceState& state_a, const SurfaceState& state_b,
                               const std::array<const TrueSurface*, 2>& known) {
  return initial_overlap(Pair(a, b, settings, {}, known), state_a, state_b);
}

void require_apart(const InitialOverlap& overlap, const std::string& pair, double allowed) {
  constexpr const char* kWaysApart =
      ": move the bodies apart (-<body>_position, -<body>_rotation, -<body>_angle0) or raise all gaps "
      "(-contact_offset)";
  const char* who = overlap.slave_side == 0 ? "first" : "second";
  require(!overlap.enclosed, "contact ", pair, ": the surface of the ", who, " body (node ",
          overlap.slave_node, ") starts inside the other body", kWaysApart);
  require(overlap.penetration <= allowed * overlap.face_size, "contact ", pair, ": node ", overlap.slave_node,
          " of the ", who, " body starts ", overlap.penetration, " m deep in face ", overlap.face,
          " of the other, allowed is ", allowed * overlap.face_size, " m (", allowed, " face sizes)",
          kWaysApart);
}

}  // namespace elastogear::contact
