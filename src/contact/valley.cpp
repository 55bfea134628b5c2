#include "contact/valley.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "contact/projection/edges.h"

namespace elastogear::contact {
namespace {

using Eigen::Vector3d;

// A slave point over a face of the master, near some of its sides.
struct Over {
  const MasterSide& master;
  const Vector3d& q;
  PointGap own;
  Face face;

  int number() const { return own.projection.face; }
};

struct BesideFace {
  int side, face;
  double share;
  PointGap over;
  Vector3d inward;  // from the side into the face that the point is over
};

bool turns_smoothly(const Over& point, const PointGap& other) {
  return point.own.gap.n.normalized().dot(other.gap.n.normalized()) >= std::cos(point.master.feature_angle);
}

// Does b rise above a on the way along `inward` into a?
bool is_concave(const PointGap& a, const PointGap& b, const Vector3d& inward) {
  return (b.gap.n - a.gap.n).dot(inward) > 0;
}

// Distance from a side in natural coordinates, 2 at the other end of the face.
double distance_from(const Over& point, int side) {
  const Eigen::Vector4d& N = point.own.projection.point.N;
  return 2 * (1 - N[side] - N[(side + 1) % point.face.sides]);
}

std::optional<BesideFace> beyond(const Over& point, int side) {
  constexpr double kLeastShare = 1e-9;
  const double share = share_beyond(distance_from(point, side));
  if (share < kLeastShare) return {};
  const SurfaceView& surface = point.master.surface;
  const int f = face_beyond(surface.topology, point.number(), side), next = (side + 1) % point.face.sides;
  if (f < 0) return {};
  const std::optional<PointGap> over = gap_over_face(point.master, f, point.q);
  if (!over || !turns_smoothly(point, *over)) return {};
  const Vector3d inward = point.own.projection.n.cross(point.face.x[next] - point.face.x[side]).normalized();
  if (!is_concave(point.own, *over, inward)) return {};
  return BesideFace{side, f, share, *over, inward};
}

// The face that meets the others at a corner alone, where all of them make a hollow.
std::optional<FaceOfValley> across_corner(const Over& point, const BesideFace& a, const BesideFace& b) {
  const int corner = (a.side + 1) % point.face.sides == b.side ? b.side : a.side;
  const int f = face_opposite(point.master.surface, point.number(), corner, {a.face, b.face});
  if (f < 0) return {};
  const std::optional<PointGap> over = gap_over_face(point.master, f, point.q);
  if (!over || !turns_smoothly(point, *over)) return {};
  const bool is_hollow = is_concave(a.over, *over, b.inward) && is_concave(b.over, *over, a.inward) &&
                         is_concave(point.own, *over, a.inward + b.inward);
  if (!is_hollow) return {};
  return FaceOfValley{over->projection, a.share * b.share, 4 + corner};
}

}  // namespace

Valley valley_at(const MasterSide& master, const Projection& projection, const Vector3d& x) {
  if (master.heights.empty()) return {};
  const Over point{master, x, point_gap(master, projection, x, 0), face_of(master.surface, projection.face)};
  if (point.own.projection.point.feature != Feature::face) return {};
  std::vector<BesideFace> near;
  for (int side = 0; side < point.face.sides; ++side)
    if (auto beside = beyond(point, side)) near.push_back(*beside);
  Valley valley;
  if (near.empty()) return valley;
  if (near.size() != 2) {
    valley.beside = {{near[0].over.projection, near[0].share, near[0].side}};
  } else {
    const BesideFace &a = near[0], &b = near[1];
    valley.beside = {{a.over.projection, a.share * (1 - b.share), a.side},
                     {b.over.projection, b.share * (1 - a.share), b.side}};
    if (const auto across = across_corner(point, a, b)) valley.beside.push_back(*across);
  }
  for (const FaceOfValley& face : valley.beside) valley.share -= face.share;
  return valley;
}

}  // namespace elastogear::contact
