#include "mesh/inp/cards/transform.h"

#include <Eigen/Geometry>
#include <bit>
#include <cmath>

namespace elastogear::mesh {
namespace {

constexpr double kAlongAxis = 1e-6;  // of directions from coordinates with six or more digits

// Columns: the local axes of a node in those of the mesh; columns of 0 where the node lies on the cylinder's
// axis.
Eigen::Matrix3d local_axes(const Transform& t, const Eigen::Vector3d& X) {
  Eigen::Matrix3d axes;
  if (t.cylindrical) {
    const Eigen::Vector3d z = (t.b - t.a).normalized(), r = X - t.a - z.dot(X - t.a) * z;
    const double size = (t.b - t.a).norm() + (X - t.a).norm();
    const Eigen::Vector3d x = r.norm() > kAlongAxis * size ? r.normalized() : Eigen::Vector3d::Zero();
    axes << x, z.cross(x), z;
  } else {
    const Eigen::Vector3d x = t.a.normalized(), z = t.a.cross(t.b).normalized();
    axes << x, z.cross(x), z;
  }
  return axes;
}

// The directions of the mesh that span the same space as the held local axes; nothing where none do.
std::optional<Directions> in_mesh_axes(const Eigen::Matrix3d& axes, Directions local) {
  Eigen::Matrix3d P = Eigen::Matrix3d::Zero();
  for (int d = 0; d < 3; ++d)
    if (holds(local, d)) P += axes.col(d) * axes.col(d).transpose();
  if (local == kAllDirections) P.setIdentity();
  int directions = 0;
  for (int d = 0; d < 3; ++d) directions |= (P(d, d) > 0.5) << d;
  const Eigen::Matrix3d whole = P.diagonal().array().round().matrix().asDiagonal();
  const bool exact = (P - whole).cwiseAbs().maxCoeff() < kAlongAxis &&
                     std::lround(P.trace()) == std::popcount(static_cast<unsigned>(local));
  if (!exact) return std::nullopt;
  return static_cast<Directions>(directions);
}

}  // namespace

Transform read_transform(InpLines& in, const Keyword& key) {
  if (!key.has("NSET")) in.fail_here("*TRANSFORM without NSET=name");
  const std::string type = key.value("TYPE");
  if (!type.empty() && type != "R" && type != "C")
    in.fail_here("*TRANSFORM with TYPE=", type, ", read are R (rectangular) and C (cylindrical)");
  Transform transform{key.parameters.at("NSET"), type == "C", {}, {}, key.line};
  if (!in.next_data()) in.fail_at(key.line, "*TRANSFORM without points");
  std::vector<double> p = in.reals("a coordinate of *TRANSFORM");
  p.resize(6, 0);
  transform.a << p[0], p[1], p[2];
  transform.b << p[3], p[4], p[5];
  const double size =
      transform.cylindrical ? (transform.b - transform.a).norm() : transform.a.cross(transform.b).norm();
  if (!(size > 0 && std::isfinite(size))) in.fail_here("the points of *TRANSFORM give no directions");
  return transform;
}

void to_mesh_axes(const InpLines& in, const std::vector<Transform>& transforms, const InpSets& node_sets,
                  const std::vector<Tag>& node_number, const Mesh& mesh, std::vector<Directions>& held) {
  for (const Transform& t : transforms) {
    const std::string* set = node_sets.spelling(t.members);
    if (!set) in.fail_at(t.line, "*TRANSFORM names the unknown node set '", t.members, "'");
    for (int node : mesh.node_sets.at(*set)) {
      if (held[node] == 0) continue;
      const auto found = in_mesh_axes(local_axes(t, mesh.X.col(node)), held[node]);
      if (!found)
        in.fail_at(
            t.line, "*TRANSFORM: node ", node_number[static_cast<std::size_t>(node)], " is held along ",
            t.cylindrical ? "cylindrical" : "turned",
            " axes that are no axes of the mesh, and nodes can be held along those alone: turn the mesh, "
            "hold the nodes in all directions, or delete the *BOUNDARY and name option restrain of reduce");
      held[node] = *found;
    }
  }
}

}  // namespace elastogear::mesh
