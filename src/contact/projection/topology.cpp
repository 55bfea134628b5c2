#include "elastogear/contact/topology.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

namespace elastogear::contact {
namespace {

Rows rows(const std::vector<std::vector<int>>& lists) {
  Rows result{{0}, {}};
  for (const auto& list : lists) {
    result.value.insert(result.value.end(), list.begin(), list.end());
    result.offset.push_back(static_cast<int>(result.value.size()));
  }
  return result;
}

void number_edges(const Eigen::Matrix4Xi& face, Topology& t) {
  std::map<std::pair<int, int>, int> number;
  std::vector<std::vector<int>> sides;
  for (int f = 0; f < face.cols(); ++f)
    for (int side = 0; side < side_count(face, f); ++side) {
      const auto [a, b] = std::minmax(face(side, f), face((side + 1) % side_count(face, f), f));
      if (a == b) continue;
      const auto [entry, is_new] = number.try_emplace({a, b}, static_cast<int>(sides.size()));
      if (is_new) sides.emplace_back();
      t.edge(side, f) = entry->second;
      sides[entry->second].push_back(4 * f + side);
    }
  t.edge_sides = rows(sides);
}

}  // namespace

int side_count(const Eigen::Matrix4Xi& face, int f) { return face(2, f) == face(3, f) ? 3 : 4; }

Topology topology(const Eigen::Matrix4Xi& face, int n_nodes) {
  Topology t;
  t.edge = Eigen::Matrix4Xi::Constant(4, face.cols(), -1);
  number_edges(face, t);
  std::vector<std::vector<int>> corners(n_nodes);
  for (int f = 0; f < face.cols(); ++f) {
    bool open = false;
    for (int i = 0; i < side_count(face, f); ++i) {
      corners[face(i, f)].push_back(4 * f + i);
      open = open || t.is_open(f, i);
    }
    if (open) t.open_faces.push_back(f);
  }
  t.node_corners = rows(corners);
  return t;
}

Face face_of(const SurfaceView& surface, int f) {
  Face result;
  result.sides = side_count(surface.face, f);
  for (int i = 0; i < 4; ++i) {
    result.x[i] = surface.at(surface.face(i, f));
    result.extension[i] = surface.topology.is_open(f, i) ? surface.extension : 0;
  }
  return result;
}

Eigen::Vector3d node_normal(const SurfaceView& surface, int node) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int entry : surface.topology.node_corners[node]) {
    const int f = entry / 4, corner = entry % 4, sides = side_count(surface.face, f);
    const auto along = [&](int other) {
      return Eigen::Vector3d(surface.at(surface.face(other % sides, f)) - surface.at(node));
    };
    const Eigen::Vector3d a = along(corner + 1), b = along(corner + sides - 1), n = a.cross(b);
    const double size = n.norm(), roundoff = 1e-14;  // of a face that is degenerate there
    if (size > roundoff * (a.squaredNorm() + b.squaredNorm())) sum += std::atan2(size, a.dot(b)) / size * n;
  }
  const double size = sum.norm(), opposite = 1e-9;  // faces back to back have no common normal
  return size > opposite ? Eigen::Vector3d(sum / size) : Eigen::Vector3d::Zero();
}

Eigen::Vector3d edge_normal(const SurfaceView& surface, int f, int side, double s) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  const int start = surface.face(side, f);
  for (int entry : surface.topology.edge_sides[surface.topology.edge(side, f)]) {
    const Face face = face_of(surface, entry / 4);
    const bool same_way = surface.face(entry % 4, entry / 4) == start;
    const Eigen::Vector2d at = on_side(face.sides, entry % 4, same_way ? s : 1 - s);
    sum += normal(face, at[0], at[1]);
  }
  return sum;
}

Eigen::VectorXd node_areas(const Eigen::Matrix3Xd& x, const Eigen::Matrix4Xi& face) {
  Eigen::VectorXd area = Eigen::VectorXd::Zero(x.cols());
  const double g = 1 / std::sqrt(3.0);  // 2 x 2 Gauss points; a triangle is a quadrilateral here
  for (int f = 0; f < face.cols(); ++f) {
    const Eigen::Matrix<double, 3, 4> corners = x(Eigen::all, face.col(f));
    for (double u : {-g, g})
      for (double v : {-g, g}) {
        const Shape s = shape(4, u, v);
        const double dA = (corners * s.N_u).cross(corners * s.N_v).norm();
        for (int i = 0; i < 4; ++i) area[face(i, f)] += dA * s.N[i];
      }
  }
  return area;
}

double face_size(const Eigen::Matrix3Xd& x, const Eigen::Matrix4Xi& face) {
  return std::sqrt(node_areas(x, face).sum() / static_cast<double>(face.cols()));
}

}  // namespace elastogear::contact
