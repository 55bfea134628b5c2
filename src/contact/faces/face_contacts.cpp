#include "contact/faces/face_contacts.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "contact/faces/overlap.h"
#include "contact/faces/second_order.h"
#include "contact/faces/weighted_candidates.h"
#include "contact/faces/weighted_gap.h"
#include "contact/forces/impacts.h"
#include "elastogear/base/sort_unique.h"

namespace elastogear::contact {
namespace {

// A quadrature point with its foot on the master.
struct Foot {
  Eigen::Vector2d at;      // (u, v) on the slave face
  Eigen::Vector4d weight;  // m^2, area times the interpolation functions
  Projection projection;
  double g;  // m
  SideWeights slave, master;
};

struct SlaveFace {
  int face;
  std::vector<Foot> feet;
};

struct Sum {
  double area = 0, gap = 0;  // m^2, m^3
};

Limits no_limits() {
  constexpr double kAny = std::numeric_limits<double>::infinity();
  return {.depth = kAny, .outside = kAny};
}

SlavePoint slave_point(int face, const Eigen::Vector2d& at) {
  SlavePoint point;
  point.face = face;
  point.at = at;
  return point;
}

std::vector<int> faces_around(const GapField& field, const std::vector<int>& nodes) {
  std::vector<int> faces;
  for (int node : nodes)
    for (int corner : field.slave.topology.node_corners[node]) faces.push_back(corner / 4);
  sort_unique(faces);
  return faces;
}

// The parts of a slave face under the master, going from face to face of it from the given ones on.
std::vector<OverlapPoint> overlap(const GapField& field, int f, std::vector<int> front) {
  const OverlapLimits limits{field.reach.limits.depth, field.reach.limits.around,
                             field.reach.limits.cos_angle};
  Face face = face_of(field.slave, f);
  face.extension = {};
  const FacePlane plane = face_plane(face);
  const SurfaceView& master = field.master.surface;
  std::vector<OverlapPoint> points;
  std::vector<int> seen = front;
  for (bool first = true; !front.empty(); first = false) {
    std::vector<int> next;
    for (int m : front)
      if (add_overlap(plane, face_of(master, m), m, limits, points) || first)
        for (int node : master.face.col(m))
          for (int corner : master.topology.node_corners[node])
            if (std::find(seen.begin(), seen.end(), corner / 4) == seen.end()) {
              seen.push_back(corner / 4);
              next.push_back(corner / 4);
            }
    front = std::move(next);
  }
  return points;
}

SideWeights weights_on(const SurfaceView& surface, const SecondOrder::Sides& sides, int f,
                       const Eigen::Vector2d& at) {
  if (sides.cols() == 0) return {};
  return side_weights(sides.col(f), face_of(surface, f), surface.face.col(f), at,
                      [&](int node) { return Eigen::Vector3d(surface.at(node)); });
}

// By how much the gap over curved sides differs from that over their faces, m.
double bulge(const GapField& field, const SecondOrder& second, const Foot& foot, const Eigen::Vector3d& n) {
  const auto of = [&](int side) { return [&, side](int node) { return second.curved(side, node); }; };
  return n.dot(combine(foot.slave, of(field.slave_side)) - combine(foot.master, of(1 - field.slave_side)));
}

std::vector<Foot> feet(const GapField& field, const SecondOrder& second, int face,
                       const std::vector<OverlapPoint>& points) {
  const Limits any = no_limits();
  std::vector<Foot> found;
  for (const OverlapPoint& p : points) {
    const SlaveGeometry s = slave_geometry(field.slave, field.heights, slave_point(face, p.at));
    const auto w = walk_to_projection(field.master.surface, s.x, any, p.master_face);
    if (!w) continue;
    const PointGap over = point_gap(field.master, *w, s.x, field.offset);
    const ClosestPoint& closest = over.projection.point;
    Foot& foot = found.emplace_back(
        Foot{p.at, p.area * s.N, *w, over.gap.g, weights_on(field.slave, second.slave, face, p.at),
             weights_on(field.master.surface, second.master, over.projection.face, {closest.u, closest.v})});
    foot.g += bulge(field, second, foot, over.gap.n);
  }
  return found;
}

// Goes from face to face of the slave: the master's face nearest to each corner, from those that are known.
std::vector<SlaveFace> slave_faces(const GapField& field, const SecondOrder& second,
                                   std::map<int, NodeGap> nearest, const std::vector<int>& faces) {
  const Limits any = no_limits();
  std::vector<SlaveFace> found;
  for (int f : faces) {
    std::vector<int> starts;
    for (int node : field.slave.face.col(f))
      if (const auto at = nearest.find(node); at != nearest.end()) starts.push_back(at->second.nearest);
    if (starts.empty()) continue;
    for (int node : field.slave.face.col(f)) {
      if (nearest.contains(node)) continue;
      const auto w = walk_to_projection(field.master.surface, field.slave.at(node), any, starts.front());
      nearest[node].nearest = w ? w->face : starts.front();
      starts.push_back(nearest[node].nearest);
    }
    sort_unique(starts);
    found.push_back({f, feet(field, second, f, overlap(field, f, starts))});
  }
  return found;
}

// The weighted gaps of these nodes that are within the reach or carry a force, still without points.
std::map<int, WeightedGap> weighted_gaps(const GapField& field, const std::vector<int>& nodes,
                                         const std::vector<SlaveFace>& faces,
                                         const std::map<int, double>& given) {
  std::map<int, Sum> sums;
  for (int node : nodes) sums[node];
  for (const SlaveFace& face : faces)
    for (int i = 0; i < side_count(field.slave.face, face.face); ++i) {
      const auto sum = sums.find(field.slave.face(i, face.face));
      if (sum == sums.end()) continue;
      for (const Foot& foot : face.feet) {
        sum->second.area += foot.weight[i];
        sum->second.gap += foot.weight[i] * foot.g;
      }
    }
  std::map<int, WeightedGap> result;
  for (const auto& [node, sum] : sums)
    if (sum.area > 0 && (sum.gap < field.reach.gap * sum.area || given.contains(node)))
      result.emplace(node, WeightedGap(field.slave_side, node));
  return result;
}

void add_points(const GapField& field, const SlaveFace& face, std::map<int, WeightedGap>& gaps) {
  const Eigen::Vector4i slave = field.slave.face.col(face.face);
  WeightedGap* corner[4] = {};
  for (int i = 0; i < side_count(field.slave.face, face.face); ++i)
    if (const auto at = gaps.find(slave[i]); at != gaps.end()) corner[i] = &at->second;
  if (std::none_of(corner, corner + 4, [](const WeightedGap* gap) { return gap; })) return;
  for (const Foot& foot : face.feet) {
    const SlaveGeometry s = slave_geometry(field.slave, field.heights, slave_point(face.face, foot.at));
    const OpenPoint open = open_point(field.master, foot.projection, s.x, field.offset);
    const HeldPoint point{
        s, open, foot.g, slave, field.master.surface.face.col(open.projection.face), foot.slave, foot.master};
    for (int i = 0; i < 4; ++i)
      if (corner[i]) corner[i]->add(point, foot.weight[i]);
  }
}

}  // namespace

std::vector<ContactPoint> face_contacts(const GapField& field, const SecondOrder& second,
                                        const FaceLaws& laws, const std::map<int, NodeGap>& nodes) {
  const std::vector<int> near = weighted_candidates(field, nodes, laws.history.p);
  const std::vector<SlaveFace> faces = slave_faces(field, second, nodes, faces_around(field, near));
  std::map<int, WeightedGap> gaps = weighted_gaps(field, near, faces, laws.history.p);
  for (const SlaveFace& face : faces) add_points(field, face, gaps);
  std::vector<ContactPoint> contacts;
  for (const auto& [node, gap] : gaps) {
    Law law = laws.law[node];
    set_given(laws.history, node, law);
    auto contact = gap.contact(law, laws.area[node],
                               {field.master.surface, laws.velocity, laws.moved, stuck_at(laws.history, node),
                                friction_at(laws.history, node)});
    if (contact) contacts.push_back(std::move(*contact));
  }
  return contacts;
}

}  // namespace elastogear::contact
