#include "contact/forces/force_direction.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "contact/projection/edges.h"
#include "contact/projection/projection_kinematics.h"

namespace elastogear::contact {
namespace {

using Eigen::Vector3d;

constexpr double kBand = 0.1;  // of natural coordinates, 2 across a face: where the face beyond has a share

// A slave point over a face of the master.
struct Foot {
  const MasterSide& master;
  const Projection& w;
  const Vector3d& q;
  const Eigen::Matrix<double, 2, 3>& xi_q;
};

std::optional<ForceDirection> gradient_over(const Foot& foot, int f) {
  const auto over = gap_over_face(foot.master, f, foot.q);
  if (!over) return {};
  return ForceDirection{over->gap.n, over->gap.n_x};
}

// What the face beyond a side has of the direction of forces: half at the side.
struct Share {
  double s;
  Eigen::RowVector3d s_q;  // 1/m
};

// distance: from the side, of natural coordinates, 1 in the middle of the face; below 0 beyond the side.
Share share_at(double distance, const Eigen::RowVector3d& distance_q) {
  const double t = std::min(1.0, std::abs(distance) / kBand);
  return {share_beyond(distance), -3 * t * (1 - t) / kBand * distance_q};
}

// A face beyond a side, with its share.
struct FaceBeside {
  int side, face;
  Share share;
  ForceDirection gradient;
};

// The face beyond a side, unless the point is far from it or surfaces end or have an edge there.
std::optional<FaceBeside> face_beside(const Foot& foot, int side, const Vector3d& n) {
  const Topology& topology = foot.master.surface.topology;
  const int own = foot.w.face, sides = side_count(foot.master.surface.face, own), next = (side + 1) % sides;
  const Shape shapes = shape(sides, foot.w.point.u, foot.w.point.v);
  const auto at_side = [=](const Eigen::Vector4d& N) { return N[side] + N[next]; };
  const Eigen::RowVector2d away(-2 * at_side(shapes.N_u), -2 * at_side(shapes.N_v));
  const Share share = share_at(2 * (1 - at_side(shapes.N)), away * foot.xi_q);
  const int f = face_beyond(topology, own, side);
  if (share.s == 0 || f < 0) return {};
  const auto over = gradient_over(foot, f);
  if (!over || over->n.normalized().dot(n.normalized()) < std::cos(foot.master.feature_angle)) return {};
  return FaceBeside{side, f, share, *over};
}

// Of the faces that meet at a corner between two sides, that which touches the others at this corner alone.
int opposite(const Foot& foot, const FaceBeside& a, const FaceBeside& b) {
  const SurfaceView& surface = foot.master.surface;
  const int own = foot.w.face, sides = side_count(surface.face, own);
  const int corner = (a.side + 1) % sides == b.side ? b.side : a.side;
  return face_opposite(surface, own, corner, {a.face, b.face});
}

ForceDirection blend(const ForceDirection& a, const ForceDirection& b, const Share& of_b) {
  return {a.n + of_b.s * (b.n - a.n), a.n_q + of_b.s * (b.n_q - a.n_q) + (b.n - a.n) * of_b.s_q};
}

}  // namespace

std::optional<PointGap> gap_over_face(const MasterSide& master, int f, const Vector3d& q) {
  const Face face = face_of(master.surface, f);
  const ClosestPoint nearest = closest_point(face, q);
  if (nearest.feature == Feature::outside) return {};
  const auto w = extended_projection(face, q, {f, nearest, {}, 0});
  if (!w) return {};
  const FaceFunction h = height(master.heights, face.sides, f, w->point.u, w->point.v);
  return PointGap{*w, gap(slave_kinematics(face, *w, q), h, 0)};
}

double share_beyond(double distance) {
  const double t = std::min(1.0, std::abs(distance) / kBand), share = 0.5 * (1 - t) * (1 - t) * (1 + 2 * t);
  return distance < 0 ? 1 - share : share;
}

ForceDirection force_direction(const MasterSide& master, const Projection& w, const Vector3d& q,
                               const ForceDirection& gradient, const Eigen::Matrix<double, 2, 3>& xi_q) {
  const Foot foot{master, w, q, xi_q};
  std::vector<FaceBeside> near;
  for (int side = 0; side < side_count(master.surface.face, w.face); ++side)
    if (const auto beside = face_beside(foot, side, gradient.n)) near.push_back(*beside);
  if (near.empty()) return gradient;
  const FaceBeside &a = near.front(), &b = near.back();
  const ForceDirection over_a = blend(gradient, a.gradient, a.share);
  if (near.size() != 2) return over_a;
  const int f = opposite(foot, a, b);
  const auto over_f = f < 0 ? std::nullopt : gradient_over(foot, f);
  const Share half{0.5, Eigen::RowVector3d::Zero()};
  const ForceDirection corner = over_f.value_or(blend(a.gradient, b.gradient, half));
  return blend(over_a, blend(b.gradient, corner, a.share), b.share);
}

}  // namespace elastogear::contact
