// Corner points of a k-DOP: intersections of three planes that satisfy all others. Meant for pictures; the
// search itself never needs the corners (realign.h).

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "elastogear/contact/kdop.h"

namespace elastogear::contact {
namespace {

struct HalfSpaces {
  Eigen::Matrix3Xd n;  // unit outward normals
  Eigen::VectorXd d;   // n . x <= d
  double tolerance;    // m, roundoff of an intersection point
};

HalfSpaces planes_of(const Kdop& dop) {
  const Directions& B = directions(dop.k);
  HalfSpaces p{Eigen::Matrix3Xd(3, dop.k), Eigen::VectorXd(dop.k), 0};
  for (int i = 0; i < B.n; ++i) {
    p.n.col(2 * i) = B[i] / B.norm[i];
    p.n.col(2 * i + 1) = -p.n.col(2 * i);
    p.d[2 * i] = dop.hi[i] / B.norm[i];
    p.d[2 * i + 1] = -dop.lo[i] / B.norm[i];
  }
  p.tolerance = 1e-12 * p.d.cwiseAbs().maxCoeff();
  return p;
}

void add_vertex(const HalfSpaces& p, const Eigen::Vector3d& x, std::vector<Eigen::Vector3d>& vertices) {
  if (((p.n.transpose() * x - p.d).array() > p.tolerance).any()) return;
  const auto same = [&](const Eigen::Vector3d& v) { return (v - x).norm() <= 8 * p.tolerance; };
  if (std::none_of(vertices.begin(), vertices.end(), same)) vertices.push_back(x);
}

std::vector<Eigen::Vector3d> vertices_of(const HalfSpaces& p) {
  std::vector<Eigen::Vector3d> vertices;
  const auto n_planes = p.d.size();
  for (Eigen::Index a = 0; a < n_planes; ++a)
    for (Eigen::Index b = a + 1; b < n_planes; ++b)
      for (Eigen::Index c = b + 1; c < n_planes; ++c) {
        Eigen::Matrix3d A;
        A << p.n.col(a).transpose(), p.n.col(b).transpose(), p.n.col(c).transpose();
        const double parallel = 1e-6;  // three of our directions span at least 0.1 or nothing at all
        if (std::abs(A.determinant()) < parallel) continue;
        add_vertex(p, A.inverse() * Eigen::Vector3d(p.d[a], p.d[b], p.d[c]), vertices);
      }
  return vertices;
}

// Vertices of one plane, sorted by angle around the plane's normal.
std::vector<int> polygon(const HalfSpaces& p, Eigen::Index plane,
                         const std::vector<Eigen::Vector3d>& vertices) {
  std::vector<int> on_plane;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (int v = 0; v < static_cast<int>(vertices.size()); ++v)
    if (std::abs(p.n.col(plane).dot(vertices[v]) - p.d[plane]) <= 8 * p.tolerance) {
      on_plane.push_back(v);
      centre += vertices[v];
    }
  centre /= std::max<double>(1, static_cast<double>(on_plane.size()));
  const Eigen::Vector3d n = p.n.col(plane), e1 = n.unitOrthogonal(), e2 = n.cross(e1);
  const auto angle = [&](int v) {
    const Eigen::Vector3d r = vertices[v] - centre;
    return std::atan2(r.dot(e2), r.dot(e1));
  };
  std::sort(on_plane.begin(), on_plane.end(), [&](int v, int w) { return angle(v) < angle(w); });
  return on_plane;
}

}  // namespace

Polyhedron polyhedron(const Kdop& dop) {
  const HalfSpaces p = planes_of(dop);
  Polyhedron result;
  result.vertices = vertices_of(p);
  for (Eigen::Index plane = 0; plane < p.d.size(); ++plane) {
    auto face = polygon(p, plane, result.vertices);
    if (face.size() >= 3) result.faces.push_back(std::move(face));
  }
  return result;
}

}  // namespace elastogear::contact
