#include "elastogear/mesh/joints.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>

#include "elastogear/base/sort_unique.h"
#include "elastogear/base/text.h"
#include "elastogear/mesh/quality.h"
#include "mesh/point_index.h"

namespace elastogear::mesh {
namespace {

constexpr double kOnePlace = 1e-2;   // of the shortest edge
constexpr double kRounding = 1e-13;  // of the largest coordinate

int root(std::vector<int>& parent, int i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

double shortest_edge(const Mesh& mesh) {
  double shortest = std::numeric_limits<double>::infinity();
  for (int cell = 0; cell < mesh.cells.size(); ++cell)
    for (const auto& [a, b] : edges(mesh.cells.type[cell]))
      shortest = std::min(shortest, (mesh.X.col(mesh.cells[cell][static_cast<std::size_t>(a)]) -
                                     mesh.X.col(mesh.cells[cell][static_cast<std::size_t>(b)]))
                                        .norm());
  return shortest;
}

// For each node the first one in its place.
std::vector<int> places(const Mesh& mesh) {
  std::vector<int> used = mesh.cells.nodes;
  sort_unique(used);
  const double near = std::max(kOnePlace * shortest_edge(mesh), kRounding * mesh.X.cwiseAbs().maxCoeff());
  const PointIndex index(mesh.X, used);
  std::vector<int> place(static_cast<std::size_t>(mesh.n_nodes()), -1);
  for (int node : used) place[node] = index.find(mesh.X.col(node), near);
  return place;
}

// A side of a cell, by its corners.
struct Side {
  Face key{}, face{};       // of places; the face points outward
  std::uint64_t nodes = 0;  // the same for sides of the same nodes, in any order
  int cell = 0, side = 0;

  auto order() const { return std::tie(key, cell, side); }
};

std::uint64_t scattered(int node) {
  std::uint64_t x = static_cast<std::uint64_t>(node) + 0x9e3779b97f4a7c15;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
  x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
  return x ^ (x >> 31);
}

std::vector<int> side_nodes(const Mesh& mesh, const Side& side) {
  return cell_side_nodes(mesh.cells.type[side.cell],
                         mesh.cells[side.cell])[static_cast<std::size_t>(side.side)];
}

// Ordered so that those in one place follow each other.
std::vector<Side> sides_by_place(const Mesh& mesh) {
  const std::vector<int> place = places(mesh);
  std::vector<Side> all;
  for (int cell = 0; cell < mesh.cells.size(); ++cell) {
    const auto sides = cell_side_nodes(mesh.cells.type[cell], mesh.cells[cell]);
    for (int i = 0; i < std::ssize(sides); ++i) {
      const std::vector<int>& nodes = sides[i];
      const std::size_t n_corners = nodes.size() > 4 ? nodes.size() / 2 : nodes.size();
      Side side{.cell = cell, .side = i};
      for (std::size_t k = 0; k < 4; ++k) side.face[k] = place[nodes[std::min(k, n_corners - 1)]];
      side.key = face_key(side.face);
      // Sides of collapsed cells that are lines separate nothing.
      if (std::adjacent_find(side.key.begin(), side.key.end()) != side.key.end()) continue;
      for (int node : nodes) side.nodes += scattered(node);
      all.push_back(side);
    }
  }
  std::sort(all.begin(), all.end(), [](const Side& a, const Side& b) { return a.order() < b.order(); });
  return all;
}

// What joint_faults() finds: sides in one place.
struct Found {
  std::map<std::array<int, 2>, const Side*> overlap;  // by cells: a side that they have in common
  std::vector<std::array<const Side*, 2>> unmerged;
};

void look_at(const Mesh& mesh, const Side& a, const Side& b, Found& found) {
  if (same_direction(a.face, b.face)) {
    if (smallest_jacobian(mesh, a.cell) > 0 && smallest_jacobian(mesh, b.cell) > 0)
      found.overlap.try_emplace({a.cell, b.cell}, &a);
  } else if (a.nodes != b.nodes) {
    found.unmerged.push_back({&a, &b});
  }
}

Found look(const Mesh& mesh, const std::vector<Side>& sides) {
  Found found;
  for (auto first = sides.begin(); first != sides.end();) {
    const auto end =
        std::find_if(first, sides.end(), [&](const Side& side) { return side.key != first->key; });
    for (auto a = first; a != end; ++a)
      for (auto b = a + 1; b != end; ++b) look_at(mesh, *a, *b, found);
    first = end;
  }
  return found;
}

std::string number_in_file(const std::vector<std::int64_t>& numbers, int i) {
  return std::to_string(numbers.empty() ? i : numbers[static_cast<std::size_t>(i)]);
}

std::string cells_text(int a, int b, const ReadReport& report) {
  return "cells " + number_in_file(report.cell_number, a) + " and " + number_in_file(report.cell_number, b);
}

std::string nodes_of(const Mesh& mesh, const Side& side, const ReadReport& report) {
  return join(side_nodes(mesh, side), " ",
              [&](int node) { return number_in_file(report.node_number, node); });
}

std::string overlap_text(const Mesh& mesh, const Found& found, const ReadReport& report) {
  if (found.overlap.empty()) return "";
  const auto& [cells, side] = *found.overlap.begin();
  const std::size_t n = found.overlap.size();
  return cells_text(cells[0], cells[1], report) +
         " fill the same place: both lie on the same side of the face of nodes " +
         nodes_of(mesh, *side, report) +
         (n > 1 ? ", the first of " + std::to_string(n) + " such pairs" : "") +
         "; mass and stiffness count twice there, delete one of the two";
}

std::string unmerged_text(const Mesh& mesh, const Found& found, const ReadReport& report) {
  const auto& pair = found.unmerged.front();
  const std::size_t n = found.unmerged.size();
  return cells_text(pair[0]->cell, pair[1]->cell, report) +
         " touch without sharing all nodes of their common face, " + nodes_of(mesh, *pair[0], report) +
         " of the one and " + nodes_of(mesh, *pair[1], report) + " of the other" +
         (n > 1 ? ", the first of " + std::to_string(n) + " such faces" : "") +
         ": the mesh is open there, and nothing is carried across; where the material goes on, merge the "
         "nodes that lie in one place (Gmsh: Coherence Mesh)";
}

// Numbers of the cells of each part by its first cell.
std::map<int, int> cells_of_parts(const Mesh& mesh) {
  const std::vector<int> part = connected_parts(mesh);
  std::map<int, int> first_cell, n_cells;
  for (int cell = 0; cell < mesh.cells.size(); ++cell)
    ++n_cells[first_cell.try_emplace(part[mesh.cells[cell].front()], cell).first->second];
  return n_cells;
}

std::string parts_text(const std::map<int, int>& parts, const ReadReport& report) {
  constexpr int kMost = 4;
  std::string text = "the mesh has " + std::to_string(parts.size()) + " parts that share no node:";
  int n = 0;
  for (const auto& [first, n_cells] : parts) {
    if (++n > kMost) return text + ", ...";
    text += (n > 1 ? ", " : " ") + std::to_string(n_cells) + (n_cells == 1 ? " cell" : " cells") +
            " from cell " + number_in_file(report.cell_number, first) + " on";
  }
  return text + "; nothing is carried from one to the other";
}

}  // namespace

std::vector<int> connected_parts(const Mesh& mesh) {
  std::vector<int> parent(static_cast<std::size_t>(mesh.n_nodes()));
  std::iota(parent.begin(), parent.end(), 0);
  for (int cell = 0; cell < mesh.cells.size(); ++cell) {
    const int first = root(parent, mesh.cells[cell].front());
    for (int node : mesh.cells[cell]) parent[root(parent, node)] = first;
  }
  for (int i = 0; i < mesh.n_nodes(); ++i) parent[i] = root(parent, i);
  return parent;
}

JointFaults joint_faults(const Mesh& mesh, const ReadReport& report) {
  if (mesh.cells.size() == 0) return {};
  const std::vector<Side> sides = sides_by_place(mesh);
  const Found found = look(mesh, sides);
  JointFaults faults{overlap_text(mesh, found, report), {}};
  if (!found.unmerged.empty()) faults.open.push_back(unmerged_text(mesh, found, report));
  if (const auto parts = cells_of_parts(mesh); parts.size() > 1)
    faults.open.push_back(parts_text(parts, report));
  return faults;
}

}  // namespace elastogear::mesh
