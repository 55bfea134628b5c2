#include "elastogear/mesh/surface_patches.h"

#include <set>

namespace elastogear::mesh {
namespace {

// Index of each node of the mesh in `nodes`; -1: none.
std::vector<int> index_in(const Mesh& mesh, const std::vector<int>& nodes) {
  std::vector<int> index(static_cast<std::size_t>(mesh.n_nodes()), -1);
  for (std::size_t i = 0; i < nodes.size(); ++i) index[nodes[i]] = static_cast<int>(i);
  return index;
}

}  // namespace

std::vector<std::vector<int>> surface_patches(const Mesh& mesh, const std::vector<int>& nodes) {
  const std::vector<int> index = index_in(mesh, nodes);
  std::vector<std::set<int>> patch(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) patch[i].insert(nodes[i]);
  for (const Face& face : boundary_faces(mesh))
    for (int node : face)
      if (index[node] >= 0) patch[index[node]].insert(face.begin(), face.end());
  std::vector<std::vector<int>> result;
  result.reserve(patch.size());
  for (const std::set<int>& each : patch) result.emplace_back(each.begin(), each.end());
  return result;
}

std::vector<int> cell_orders(const Mesh& mesh, const std::vector<int>& nodes) {
  const std::vector<int> index = index_in(mesh, nodes);
  std::vector<int> order(nodes.size(), 1);
  for (int cell = 0; cell < mesh.cells.size(); ++cell) {
    const auto of_cell = mesh.cells[cell];
    if (static_cast<int>(of_cell.size()) == corner_count(mesh.cells.type[cell])) continue;
    for (int node : of_cell)
      if (index[node] >= 0) order[index[node]] = 2;
  }
  return order;
}

}  // namespace elastogear::mesh
