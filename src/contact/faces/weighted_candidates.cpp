#include "contact/faces/weighted_candidates.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <set>

namespace elastogear::contact {
namespace {

using Eigen::Vector2d;

// The gap at a corner of a face, m, and its slope with (u, v).
struct CornerGap {
  Vector2d at, slope;
  double g;
};

// The gap over a face by those of its corners that are known.
struct FaceGaps {
  std::vector<CornerGap> known;
  bool complete = true;
  double area = 0;   // m^2
  double slack = 0;  // m, by which a gap over facets may bend downwards
};

constexpr double kFacet = 0.5;  // of the rise over two faces: that of one face over its facet

// Centre of the interpolation function of a corner.
Vector2d centre_of(int sides, int corner) {
  const Vector2d at = on_side(sides, corner, 0);
  return sides == 4 ? Vector2d(at / 3) : Vector2d(0.25 * Vector2d(1, 1) + 0.25 * at);
}

FaceGaps face_gaps(const GapField& field, int f, const std::map<int, NodeGap>& nodes) {
  const Eigen::Matrix4Xi& face = field.slave.face;
  const int sides = side_count(face, f);
  FaceGaps gaps;
  const auto x = [&](int corner) { return field.slave.at(face(corner, f)); };
  gaps.area = 0.5 * (x(2) - x(0)).cross(x(sides - 1) - x(1)).norm();
  for (int c = 0; c < sides; ++c) {
    const auto node = nodes.find(face(c, f));
    if (node == nodes.end()) {
      gaps.complete = false;
      continue;
    }
    const auto& [g, n, nearest] = node->second;
    gaps.known.push_back(
        {on_side(sides, c, 0), corner_tangents(field.slave, field.heights, f, c).transpose() * n, g});
    if (field.heights.empty())
      gaps.slack = std::max(gaps.slack, kFacet * sag(field.reach, field.slave_side, f, nearest));
  }
  return gaps;
}

// Below the mean of a convex gap over the part of a face that a corner has: that over the tangent planes at
// its centre; where a part of the face may lie beyond the master, the least known gap.
double least_mean(const FaceGaps& gaps, const Vector2d& centre) {
  double planes = -kNoGap, least = kNoGap;
  for (const CornerGap& t : gaps.known) {
    planes = std::max(planes, t.g + t.slope.dot(centre - t.at));
    least = std::min(least, t.g);
  }
  return (gaps.complete ? planes : std::min(planes, least)) - gaps.slack;
}

}  // namespace

std::vector<int> weighted_candidates(const GapField& field, const std::map<int, NodeGap>& nodes,
                                     const std::map<int, double>& given) {
  constexpr int kMargin = 2;  // of the reach, as gaps over deformed surfaces are not quite convex
  const double within = kMargin * field.reach.gap;
  std::map<int, FaceGaps> faces;
  std::set<int> candidates;
  for (const auto& [node, force] : given) candidates.insert(node);
  for (const auto& [node, gap] : nodes) {
    double sum = 0, area = 0;
    bool partial = false;
    for (int entry : field.slave.topology.node_corners[node]) {
      const int f = entry / 4;
      auto at = faces.find(f);
      if (at == faces.end()) at = faces.emplace(f, face_gaps(field, f, nodes)).first;
      const double mean = least_mean(at->second, centre_of(side_count(field.slave.face, f), entry % 4));
      sum += at->second.area * mean;
      area += at->second.area;
      partial = partial || (!at->second.complete && mean <= within);
    }
    // In a valley of the master gaps are not convex; but where they are small at a node, it is near enough.
    if (gap.g <= within || partial || sum <= within * area) candidates.insert(node);
  }
  for (const auto& [f, gaps] : faces)
    if (!gaps.complete && least_mean(gaps, {0, 0}) <= within)
      for (int node : field.slave.face.col(f)) candidates.insert(node);
  return {candidates.begin(), candidates.end()};
}

}  // namespace elastogear::contact
