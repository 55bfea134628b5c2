#include "contact/search/reach.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "elastogear/base/error.h"

namespace elastogear::contact {
namespace {

double diagonal(const model::Surface& surface, int f) {
  double longest = 0;
  for (int i = 0; i < 2; ++i)
    longest =
        std::max(longest, (surface.X.col(surface.face(i + 2, f)) - surface.X.col(surface.face(i, f))).norm());
  return longest;
}

double largest(const std::vector<double>& values) {
  return values.empty() ? 0 : *std::max_element(values.begin(), values.end());
}

// The largest value of the faces of which a corner is within `distance` (m) of face f, going from face to
// face.
double largest_around(const model::Surface& surface, const Topology& topology,
                      const std::vector<double>& value, int f, double distance, std::vector<int>& seen) {
  const Eigen::Vector3d centre = surface.X.col(surface.face(0, f));
  double result = value[f];
  std::vector<int> front{f};
  seen[f] = f;
  while (!front.empty()) {
    const int from = front.back();
    front.pop_back();
    result = std::max(result, value[from]);
    for (int node : surface.face.col(from)) {
      if ((surface.X.col(node) - centre).norm() > distance) continue;
      for (int corner : topology.node_corners[node])
        if (const int next = corner / 4; seen[next] != f) seen[next] = f, front.push_back(next);
    }
  }
  return result;
}

// Faces at a side across which normals turn by more than the feature angle (rad).
std::vector<int> sharp_faces(const SurfaceView& surface, double feature_angle) {
  std::vector<Eigen::Vector3d> n;
  for (int f = 0; f < surface.face.cols(); ++f) n.push_back(normal(face_of(surface, f), 0.25, 0.25));
  std::vector<int> faces;
  for (int edge = 0; edge < surface.topology.edge_sides.size(); ++edge)
    for (int a : surface.topology.edge_sides[edge])
      for (int b : surface.topology.edge_sides[edge])
        if (n[a / 4].dot(n[b / 4]) < std::cos(feature_angle)) faces.push_back(a / 4);
  return faces;
}

// reach: m, how far a point may move as it is held against the surface. feature_angle: rad, beyond which
// edges are sharp; 0: there are none.
FaceShapes face_shapes(const Tracked& tracked, const Heights& heights, double reach, double feature_angle) {
  constexpr int kSurroundings = 8;  // lengths of a face, beyond which its surroundings are the whole surface
  const model::Surface& surface = *tracked.surface;
  const SurfaceView undeformed{surface.face, tracked.topology, surface.X, 0};
  const auto n = static_cast<int>(surface.face.cols());
  FaceShapes shapes;
  for (int f = 0; f < n; ++f) {
    shapes.diagonal.push_back(diagonal(surface, f));
    shapes.curvature.push_back(largest_curvature(undeformed, heights, f));
  }
  if (feature_angle > 0)
    for (int f : sharp_faces(undeformed, feature_angle))
      shapes.curvature[f] = std::numeric_limits<double>::infinity();
  shapes.largest_curvature = largest(shapes.curvature);
  std::vector<int> seen(static_cast<std::size_t>(n), -1);
  for (int f = 0; f < n; ++f) {
    const double d = shapes.diagonal[f];
    shapes.curvature_around.push_back(
        reach > kSurroundings * d
            ? shapes.largest_curvature
            : largest_around(surface, tracked.topology, shapes.curvature, f, d + reach, seen));
  }
  return shapes;
}

double largest_sag(const Reach& reach, int slave_side, std::span<const int> corners, int master_face) {
  double result = 0;
  for (int corner : corners) result = std::max(result, sag(reach, slave_side, corner / 4, master_face));
  return result;
}

double largest_sag(const Reach& reach, int slave_side) {
  double result = 0;
  for (int f = 0; f < static_cast<int>(reach.shapes[slave_side].diagonal.size()); ++f)
    result = std::max(result, sag(reach, slave_side, f, -1));
  return result;
}

double largest_diagonal(const model::Surface& surface) {
  double result = 0;
  for (int f = 0; f < surface.face.cols(); ++f) result = std::max(result, diagonal(surface, f));
  return result;
}

}  // namespace

double sag(const Reach& reach, int slave_side, int f, int master_face) {
  const FaceShapes& slave = reach.shapes[slave_side];
  const FaceShapes& master = reach.shapes[1 - slave_side];
  const double curvature = slave.curvature[f] + (master_face < 0 ? master.largest_curvature
                                                                 : master.curvature_around[master_face]);
  const double d = slave.diagonal[f];
  return std::min(reach.rise * curvature * d * d, reach.most * d);
}

Limits limits_at(const Reach& reach, int slave_side, std::span<const int> corners) {
  Limits limits = reach.limits;
  if (!reach.shapes[slave_side].diagonal.empty())
    limits.outside = reach.nearest + largest_sag(reach, slave_side, corners, -1);
  return limits;
}

std::vector<double> spare(const Reach& reach, int slave_side, const Topology& topology) {
  std::vector<double> result;
  if (reach.shapes[slave_side].diagonal.empty()) return result;
  for (int node = 0; node < topology.node_corners.size(); ++node)
    result.push_back(reach.limits.outside -
                     limits_at(reach, slave_side, topology.node_corners[node]).outside);
  return result;
}

double largest_gap_at(const Reach& reach, int slave_side, std::span<const int> corners, int master_face) {
  return reach.gap + largest_sag(reach, slave_side, corners, master_face);
}

// Open candidates of a law without a penalty are near enough to close within an evaluation, or to be left
// open on the way to an equilibrium; others are found in the next one. -, of the depth.
double share_of_depth(ContactLaw law) {
  return law == ContactLaw::unilateral ? 0.02 : law == ContactLaw::augmented ? 0.25 : 0;
}

// Facets that a surface with heights lies behind are touched from outside, and so is what the offset moves
// out.
Reach reach_of(const Settings& settings, const std::array<const Tracked*, 2>& tracked,
               const std::array<const Heights*, 2>& heights) {
  Reach r;
  r.gap = share_of_depth(settings.law) * settings.depth;
  const double height = r.gap + std::max(largest_height(*heights[0], settings.extension),
                                         largest_height(*heights[1], settings.extension));
  r.limits.depth = settings.depth + height + std::max(0.0, settings.offset);
  r.limits.cos_angle = std::cos(settings.normal_angle * std::numbers::pi / 180);
  r.nearest = r.limits.outside = height + std::max(0.0, -settings.offset);
  if (settings.points == SlavePoints::nodes) return r;
  double feature_angle = 0;
  if (settings.points == SlavePoints::faces) {
    r.rise = 0.25;
    r.most = 1;
    feature_angle = settings.feature_angle * std::numbers::pi / 180;
  }
  const std::array<double, 2> d{largest_diagonal(*tracked[0]->surface),
                                largest_diagonal(*tracked[1]->surface)};
  const int slave_side = settings.slave;
  const double master_size = 2 * tracked[1 - slave_side]->ball.radius;
  require(settings.points != SlavePoints::faces || d[slave_side] < master_size,
          "contact: points 'faces': the largest face of the slave has a diagonal of ", d[slave_side],
          " m, the whole surface of the master ", master_size,
          " m: a slave of faces so large misses it; exchange the two (slave)");
  for (int i : {0, 1}) r.shapes[i] = face_shapes(*tracked[i], *heights[i], d[1 - i], feature_angle);
  r.limits.outside += std::max(largest_sag(r, 0), largest_sag(r, 1));
  for (int slave : slave_sides(settings))
    r.limits.around = std::max(r.limits.around, d[slave] + r.limits.outside);
  return r;
}

}  // namespace elastogear::contact
