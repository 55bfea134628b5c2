#include "gear/second_order.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "elastogear/base/error.h"

namespace elastogear::gear {
namespace {

using mesh::CellType;
using Edge = std::pair<int, int>;  // of two nodes of the linear mesh, the smaller number first

// Edges of the linear mesh and the numbers of their midside nodes.
struct Edges {
  int n_nodes = 0, sectors = 1;  // of the linear mesh
  std::map<Edge, int> number;

  int per_sector() const { return static_cast<int>(number.size()) / sectors; }
  int nodes_per_sector() const { return n_nodes / sectors; }
  // Number of a node of the linear mesh in the new one.
  int corner(int node) const { return node + node / nodes_per_sector() * per_sector(); }
  int midside(int a, int b) const { return number.at(std::minmax(a, b)); }
};

// An edge as its sector sees it: the sector, and both nodes counted from the sector's first one.
std::array<int, 3> seen_from_sector(const Edges& edges, const Edge& edge) {
  const int n = edges.nodes_per_sector();
  const auto [a, b] = edge;
  const int of_a = a / n, of_b = b / n;
  if (of_a == of_b) return {of_a, a % n, b % n};
  if ((of_a + 1) % edges.sectors == of_b) return {of_a, a % n, n + b % n};
  return {of_b, b % n, n + a % n};
}

Edges number_edges(const mesh::Mesh& linear, int sectors) {
  Edges edges{.n_nodes = linear.n_nodes(), .sectors = sectors, .number = {}};
  for (int cell = 0; cell < linear.cells.size(); ++cell)
    for (const auto& [a, b] : mesh::edges(CellType::hex8))
      edges.number.emplace(std::minmax(linear.cells[cell][a], linear.cells[cell][b]), 0);
  std::vector<std::pair<std::array<int, 3>, Edge>> ordered;
  for (const auto& [edge, number] : edges.number) ordered.emplace_back(seen_from_sector(edges, edge), edge);
  std::sort(ordered.begin(), ordered.end());
  const int n = edges.nodes_per_sector(), m = edges.per_sector();
  for (int i = 0; i < static_cast<int>(ordered.size()); ++i)
    edges.number[ordered[static_cast<std::size_t>(i)].second] = i / m * (n + m) + n + i % m;
  return edges;
}

Eigen::Matrix3Xd positions_of(const mesh::Mesh& linear, const Edges& edges, const Midside& midside) {
  Eigen::Matrix3Xd X(3, linear.n_nodes() + static_cast<int>(edges.number.size()));
  for (int node = 0; node < linear.n_nodes(); ++node) X.col(edges.corner(node)) = linear.X.col(node);
  for (const auto& [edge, number] : edges.number) X.col(number) = midside(edge.first, edge.second);
  return X;
}

void add_cells(mesh::Mesh& mesh, const mesh::Mesh& linear, const Edges& edges) {
  for (int cell = 0; cell < linear.cells.size(); ++cell) {
    const auto nodes = linear.cells[cell];
    require(linear.cells.type[cell] == CellType::hex8, "cell ", cell, " has no 8 nodes");
    std::array<int, 20> all{};
    for (int corner = 0; corner < 8; ++corner) all[corner] = edges.corner(nodes[corner]);
    int next = 8;
    for (const auto& [a, b] : mesh::edges(CellType::hex8)) all[next++] = edges.midside(nodes[a], nodes[b]);
    mesh.cells.add(CellType::hex20, all);
  }
}

std::vector<int> second_order_set(const mesh::Mesh& linear, const std::vector<int>& nodes,
                                  const Edges& edges) {
  std::vector<bool> in_set(static_cast<std::size_t>(linear.n_nodes()), false);
  for (int node : nodes) in_set[node] = true;
  std::vector<int> all;
  for (int node : nodes) all.push_back(edges.corner(node));
  for (const auto& [edge, number] : edges.number)
    if (in_set[edge.first] && in_set[edge.second]) all.push_back(number);
  std::sort(all.begin(), all.end());
  return all;
}

std::vector<mesh::Face> cut_faces(const std::vector<mesh::Face>& faces, const Edges& edges) {
  std::vector<mesh::Face> all;
  for (const mesh::Face& face : faces) {
    std::array<int, 8> side{};
    for (int i = 0; i < 4; ++i) {
      side[i] = edges.corner(face[i]);
      side[4 + i] = edges.midside(face[i], face[(i + 1) % 4]);
    }
    for (const mesh::Face& part : mesh::side_faces(side)) all.push_back(part);
  }
  return all;
}

}  // namespace

mesh::Mesh second_order(const mesh::Mesh& linear, const Midside& midside, int sectors) {
  const Edges edges = number_edges(linear, sectors);
  mesh::Mesh mesh;
  mesh.X = positions_of(linear, edges, midside);
  add_cells(mesh, linear, edges);
  mesh.cell_sets = linear.cell_sets;
  for (const auto& [name, nodes] : linear.node_sets)
    mesh.node_sets[name] = second_order_set(linear, nodes, edges);
  for (const auto& [name, faces] : linear.face_sets) mesh.face_sets[name] = cut_faces(faces, edges);
  return mesh;
}

void check_order(const std::string& body, int order) {
  require(order == 1 || order == 2, "the ", body, "'s element_order = ", order,
          ": must be 1 (hexahedra of 8 nodes) or 2 (of 20 nodes)");
}

}  // namespace elastogear::gear
