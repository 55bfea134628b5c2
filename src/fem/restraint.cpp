#include "elastogear/fem/restraint.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <map>
#include <set>
#include <sstream>

#include "elastogear/base/error.h"
#include "elastogear/mesh/joints.h"

namespace elastogear::fem {
namespace {

constexpr double kFree = 1e-6;  // of the restrained nodes' extent: motions that are held by less are free

using Matrix6 = Eigen::Matrix<double, 6, 6>;

// A space of rigid motions t + w x (X - centre), of columns [t; length w].
struct RigidMotions {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double length = 1;  // m
  Eigen::Index dimension = 6;
  Matrix6 projector = Matrix6::Identity();  // orthogonal, on the space
};

// Takes what the columns of A span off the motions, by the longest column that is left at a time.
void hold(Eigen::Matrix<double, 6, Eigen::Dynamic> A, RigidMotions& left) {
  Eigen::Index pivot = 0;
  const double first = A.colwise().norm().maxCoeff();
  for (; left.dimension > 0; --left.dimension) {
    const double longest = A.colwise().norm().maxCoeff(&pivot);
    if (longest <= kFree * first) return;
    const Eigen::Vector<double, 6> q = (left.projector * A.col(pivot)).normalized();
    for (auto a : A.colwise()) a -= q.dot(a) * q;
    left.projector -= q * q.transpose();
  }
}

// Rigid motions that move none of the held displacements. A motion displaces node X along e by [e; (X - c) x
// e] times [t; w]: the rank of these columns, docs/theory, Eq. (1.6a), is found by pivots, which do not
// depend on how many nodes are held.
RigidMotions free_motions(const mesh::Mesh& mesh, const std::vector<mesh::Directions>& held,
                          const std::vector<int>& nodes) {
  RigidMotions left;
  if (nodes.empty()) return left;
  Eigen::Matrix3Xd r = mesh.X(Eigen::all, nodes);
  left.centre = r.rowwise().mean();
  r.colwise() -= left.centre;
  if (const double extent = r.colwise().norm().maxCoeff(); extent > 0) left.length = extent;
  Eigen::Matrix<double, 6, Eigen::Dynamic> A(6, 3 * r.cols());
  Eigen::Index n = 0;
  for (Eigen::Index i = 0; i < r.cols(); ++i)
    for (int d = 0; d < 3; ++d) {
      if (!mesh::holds(held[nodes[static_cast<std::size_t>(i)]], d)) continue;
      const Eigen::Vector3d e = Eigen::Vector3d::Unit(d);
      A.col(n++) << e, r.col(i).cross(e) / left.length;
    }
  hold(A.leftCols(n), left);
  return left;
}

// Components for messages, without roundoff.
Eigen::RowVector3d readable(const Eigen::Vector3d& v, double size) {
  return (v / (kFree * size)).array().round() * (kFree * size) + 0.0;
}

// Orthonormal directions that span the image, of dimension n, of an orthogonal projector: coordinate axes
// where they can be.
std::vector<Eigen::Vector3d> along_axes(Eigen::Matrix3d projector, Eigen::Index n) {
  std::vector<Eigen::Vector3d> directions;
  while (static_cast<Eigen::Index>(directions.size()) < n) {
    int axis = 0;
    for (int i : {1, 2})
      if (projector(i, i) > projector(axis, axis) + kFree) axis = i;
    const Eigen::Vector3d v = projector.col(axis).normalized();
    projector -= v * v.transpose();
    directions.push_back(v);
  }
  return directions;
}

// "move along (1 0 0), turn about (0 0 1) through (0 0 0) m"
std::string describe(const RigidMotions& left) {
  const Eigen::Matrix3d P_tt = left.projector.topLeftCorner<3, 3>(),
                        P_tw = left.projector.topRightCorner<3, 3>(),
                        P_ww = left.projector.bottomRightCorner<3, 3>();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(P_ww);
  const Eigen::Array3d is_turn = (eigen.eigenvalues().array() > kFree * kFree).cast<double>();
  const auto n_turns = static_cast<Eigen::Index>(is_turn.sum()), n_moves = left.dimension - n_turns;
  const Eigen::Vector3d inverse = (is_turn > 0).select(eigen.eigenvalues().cwiseInverse(), 0);
  const Eigen::Matrix3d& U = eigen.eigenvectors();
  // The least motion that turns by e / length moves the centre by S e.
  const Eigen::Matrix3d S = P_tw * U * inverse.asDiagonal() * U.transpose();
  std::ostringstream text;
  const char* comma = "";
  for (const Eigen::Vector3d& e : along_axes(P_tt - S * P_tw.transpose(), n_moves)) {
    text << comma << "move along (" << readable(e, 1) << ")";
    comma = ", ";
  }
  for (const Eigen::Vector3d& e : along_axes(U * is_turn.matrix().asDiagonal() * U.transpose(), n_turns)) {
    text << comma << "turn about (" << readable(e, 1) << ") through ("
         << readable(left.centre + left.length * e.cross(S * e), left.length) << ") m";
    comma = ", ";
  }
  return text.str();
}

}  // namespace

std::vector<mesh::Directions> held_directions(const mesh::Mesh& mesh,
                                              const std::vector<std::string>& restrain) {
  std::vector<mesh::Directions> held = mesh::held_by(mesh, restrain);
  std::vector<bool> in_cell(held.size(), false);
  for (int node : mesh.cells.nodes) in_cell[node] = true;
  for (std::size_t node = 0; node < held.size(); ++node)
    if (!in_cell[node]) held[node] = mesh::kAllDirections;
  return held;
}

std::vector<bool> free_nodes(const std::vector<mesh::Directions>& held) {
  std::vector<bool> is_free;
  for (mesh::Directions directions : held) is_free.push_back(directions != mesh::kAllDirections);
  return is_free;
}

std::vector<bool> free_nodes(const mesh::Mesh& mesh, const std::vector<std::string>& restrain) {
  return free_nodes(held_directions(mesh, restrain));
}

std::vector<int> free_dofs(const std::vector<mesh::Directions>& held) {
  std::vector<int> dofs;
  for (int node = 0; node < static_cast<int>(held.size()); ++node)
    for (int d = 0; d < 3; ++d)
      if (!mesh::holds(held[node], d)) dofs.push_back(3 * node + d);
  return dofs;
}

std::vector<mesh::Directions> held_directions(const std::vector<int>& free_dof, int n_nodes) {
  std::vector<mesh::Directions> held(static_cast<std::size_t>(n_nodes), mesh::kAllDirections);
  for (int dof : free_dof) held[dof / 3] = static_cast<mesh::Directions>(held[dof / 3] & ~(1 << dof % 3));
  return held;
}

void require_held(const mesh::Mesh& mesh, const std::vector<mesh::Directions>& held) {
  const std::vector<int> part = mesh::connected_parts(mesh);
  std::map<int, std::vector<int>> nodes_of;
  for (int node : mesh.cells.nodes) nodes_of[part[node]];
  for (int node = 0; node < mesh.n_nodes(); ++node)
    if (held[node] != 0 && nodes_of.contains(part[node])) nodes_of[part[node]].push_back(node);
  for (const auto& [node, nodes] : nodes_of) {
    const RigidMotions left = free_motions(mesh, held, nodes);
    if (left.dimension == 0) continue;
    fail("the stiffness is singular: the connected part of the mesh with ", mesh::node_text(mesh, node),
         " has ", nodes.size(), " restrained nodes, which leave it free to ", describe(left),
         "; hold more nodes or directions by the option restrain");
  }
}

void require_connected(const mesh::Mesh& mesh) {
  const std::vector<int> part = mesh::connected_parts(mesh);
  std::set<int> parts;
  for (int node : mesh.cells.nodes) parts.insert(part[node]);
  require(parts.size() == 1, "a free body must hang together, the mesh has ", parts.size(),
          " parts: restrain them, or reduce them one by one");
}

}  // namespace elastogear::fem
