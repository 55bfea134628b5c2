#include "elastogear/fem/restraint.h"

#include <Eigen/Eigenvalues>
#include <map>
#include <numeric>
#include <set>

#include "elastogear/base/error.h"
#include "elastogear/mesh/named_nodes.h"

namespace elastogear::fem {
namespace {

constexpr double kOnOneLine = 1e-6;  // width of the restrained nodes over their length

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

// True when the points lie on one line (or are fewer than three): the second of the cloud's principal
// lengths vanishes beside the first.
bool on_one_line(const mesh::Mesh& mesh, const std::vector<int>& nodes) {
  if (nodes.size() < 3) return true;
  Eigen::Matrix3Xd X = mesh.X(Eigen::all, nodes);
  X.colwise() -= Eigen::Vector3d(X.rowwise().mean());
  const Eigen::Vector3d squares =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(X * X.transpose()).eigenvalues();
  return !(squares(1) > kOnOneLine * kOnOneLine * squares(2));
}

}  // namespace

std::vector<bool> free_nodes(const mesh::Mesh& mesh, const std::vector<std::string>& restrained_sets) {
  std::vector<bool> is_free(static_cast<std::size_t>(mesh.n_nodes()), false);
  for (int node : mesh.cells.nodes) is_free[node] = true;
  for (const std::string& name : restrained_sets)
    for (int node : mesh::named_nodes(mesh, name).node) is_free[node] = false;
  return is_free;
}

std::vector<int> free_dofs(const std::vector<bool>& is_free) {
  std::vector<int> dofs;
  for (int node = 0; node < static_cast<int>(is_free.size()); ++node)
    if (is_free[node]) dofs.insert(dofs.end(), {3 * node, 3 * node + 1, 3 * node + 2});
  return dofs;
}

void require_held(const mesh::Mesh& mesh, const std::vector<bool>& is_free) {
  const std::vector<int> part = connected_parts(mesh);
  std::map<int, std::vector<int>> held;
  for (int node : mesh.cells.nodes) held[part[node]];
  for (int node = 0; node < mesh.n_nodes(); ++node)
    if (!is_free[node] && held.contains(part[node])) held[part[node]].push_back(node);
  for (const auto& [node, nodes] : held)
    require(!on_one_line(mesh, nodes), "the stiffness is singular: the connected part of the mesh with node ",
            node, " (counted from 0) has ", nodes.size(), nodes.size() < 3 ? "" : " collinear",
            " restrained nodes, at least three that are not on one line are needed (option restrain)");
}

void require_connected(const mesh::Mesh& mesh) {
  const std::vector<int> part = connected_parts(mesh);
  std::set<int> parts;
  for (int node : mesh.cells.nodes) parts.insert(part[node]);
  require(parts.size() == 1, "a free body must hang together, the mesh has ", parts.size(),
          " parts: restrain them, or reduce them one by one");
}

}  // namespace elastogear::fem
