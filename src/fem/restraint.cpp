#include "elastogear/fem/restraint.h"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <map>
#include <numeric>
#include <set>
#include <sstream>

#include "elastogear/base/error.h"

namespace elastogear::fem {
namespace {

constexpr double kFree = 1e-6;  // of the restrained nodes' extent: motions that are held by less are free

int root(std::vector<int>& parent, int i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

// Union-find over the nodes: nodes of one connected part have one root.
std::vector<int> connected_parts(const mesh::Mesh& mesh) {
  std::vector<int> parent(static_cast<std::size_t>(mesh.n_nodes()));
  std::iota(parent.begin(), parent.end(), 0);
  for (int cell = 0; cell < mesh.cells.size(); ++cell) {
    const int first = root(parent, mesh.cells[cell].front());
    for (int node : mesh.cells[cell]) parent[root(parent, node)] = first;
  }
  for (int i = 0; i < mesh.n_nodes(); ++i) parent[i] = root(parent, i);
  return parent;
}

// Rigid motions t + w x (X - centre): columns [t; length w], orthonormal.
struct RigidMotions {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double length = 1;  // m
  Eigen::MatrixXd motion = Eigen::MatrixXd::Identity(6, 6);
};

// Rigid motions that move none of the held displacements. A motion displaces node X along e by [e; (X - c) x
// e] times [t; w]: the rank of these columns, docs/theory.md, Eq. (1.6a), is found by pivots, which do not
// depend on how many nodes are held.
RigidMotions free_motions(const mesh::Mesh& mesh, const std::vector<mesh::Directions>& held,
                          const std::vector<int>& nodes) {
  RigidMotions left;
  if (nodes.empty()) return left;
  Eigen::Matrix3Xd r = mesh.X(Eigen::all, nodes);
  left.centre = r.rowwise().mean();
  r.colwise() -= left.centre;
  if (const double extent = r.colwise().norm().maxCoeff(); extent > 0) left.length = extent;
  Eigen::MatrixXd A(6, 3 * r.cols());
  Eigen::Index n = 0;
  for (Eigen::Index i = 0; i < r.cols(); ++i)
    for (int d = 0; d < 3; ++d) {
      if (!mesh::holds(held[nodes[static_cast<std::size_t>(i)]], d)) continue;
      const Eigen::Vector3d e = Eigen::Vector3d::Unit(d);
      A.col(n++) << e, r.col(i).cross(e) / left.length;
    }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
  qr.setThreshold(kFree);
  qr.compute(A.leftCols(n));
  const Eigen::MatrixXd Q = qr.householderQ() * Eigen::MatrixXd::Identity(6, 6);
  left.motion = Q.rightCols(6 - qr.rank());
  return left;
}

// Components for messages, without roundoff.
Eigen::RowVector3d readable(const Eigen::Vector3d& v, double size) {
  return (v / (kFree * size)).array().round() * (kFree * size) + 0.0;
}

// Orthonormal directions that span what the orthonormal columns of A do: coordinate axes where they can be.
std::vector<Eigen::Vector3d> along_axes(const Eigen::MatrixXd& A) {
  Eigen::Matrix3d projector = A * A.transpose();
  std::vector<Eigen::Vector3d> directions;
  while (static_cast<Eigen::Index>(directions.size()) < A.cols()) {
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
  const Eigen::MatrixXd T = left.motion.topRows<3>(), W = left.motion.bottomRows<3>();
  Eigen::JacobiSVD<Eigen::MatrixXd> turning(W, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Index n_turns = (turning.singularValues().array() > kFree).count(),
                     n_moves = W.cols() - n_turns;
  const Eigen::MatrixXd V = turning.matrixV().leftCols(n_turns), U = turning.matrixU().leftCols(n_turns);
  std::ostringstream text;
  const char* comma = "";
  for (const Eigen::Vector3d& e : along_axes(T * turning.matrixV().rightCols(n_moves))) {
    text << comma << "move along (" << readable(e, 1) << ")";
    comma = ", ";
  }
  for (const Eigen::Vector3d& e : along_axes(U)) {
    const Eigen::VectorXd c = V * (U.transpose() * e).cwiseQuotient(turning.singularValues().head(n_turns));
    const Eigen::Vector3d t = T * c;  // of the turn by e / length about the centre
    text << comma << "turn about (" << readable(e, 1) << ") through ("
         << readable(left.centre + left.length * e.cross(t), left.length) << ") m";
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

void require_held(const mesh::Mesh& mesh, const std::vector<mesh::Directions>& held) {
  const std::vector<int> part = connected_parts(mesh);
  std::map<int, std::vector<int>> nodes_of;
  for (int node : mesh.cells.nodes) nodes_of[part[node]];
  for (int node = 0; node < mesh.n_nodes(); ++node)
    if (held[node] != 0 && nodes_of.contains(part[node])) nodes_of[part[node]].push_back(node);
  for (const auto& [node, nodes] : nodes_of) {
    const RigidMotions left = free_motions(mesh, held, nodes);
    if (left.motion.cols() == 0) continue;
    fail("the stiffness is singular: the connected part of the mesh with node ", node,
         " (counted from 0) has ", nodes.size(), " restrained nodes, which leave it free to ", describe(left),
         "; hold more nodes or directions by the option restrain");
  }
}

void require_connected(const mesh::Mesh& mesh) {
  const std::vector<int> part = connected_parts(mesh);
  std::set<int> parts;
  for (int node : mesh.cells.nodes) parts.insert(part[node]);
  require(parts.size() == 1, "a free body must hang together, the mesh has ", parts.size(),
          " parts: restrain them, or reduce them one by one");
}

}  // namespace elastogear::fem
