#include "elastogear/mesh/mesh.h"

#include <algorithm>
#include <unordered_map>

#include "elastogear/base/error.h"
#include "elastogear/base/text.h"

namespace elastogear::mesh {
namespace {

struct KeyHash {
  std::size_t operator()(const Face& f) const {
    std::size_t h = 0;
    for (int i : f) h = h * 1000003u + static_cast<std::size_t>(i);
    return h;
  }
};

template <class Set>
const Set& named(const std::map<std::string, Set>& sets, const std::string& name, const char* kind) {
  const auto found = sets.find(name);
  if (found != sets.end()) return found->second;
  fail("the mesh has no ", kind, " set '", name, "'; it has: ", sets.empty() ? "none" : join_keys(sets));
}

using FaceMap = std::unordered_map<Face, int, KeyHash>;

FaceMap count_faces(const Mesh& mesh) {
  FaceMap count;
  count.reserve(static_cast<std::size_t>(mesh.cells.size()) * 4);
  for (int i = 0; i < mesh.cells.size(); ++i)
    for (const Face& face : cell_faces(mesh.cells.type[i], mesh.cells[i])) ++count[face_key(face)];
  return count;
}

void validate_members(const std::map<std::string, std::vector<int>>& sets, int n, const char* kind,
                      const std::string& source) {
  for (const auto& [name, members] : sets)
    for (int i : members)
      require(i >= 0 && i < n, source, ": ", kind, " set '", name, "' names ", kind, " ", i,
              ", allowed are 0..", n - 1);
}

void validate_cells(const Mesh& mesh, const std::string& source) {
  const Cells& cells = mesh.cells;
  require(cells.offset.size() == cells.type.size() + 1 &&
              cells.offset.back() == static_cast<int>(cells.nodes.size()),
          source, ": cell table is inconsistent");
  for (int i = 0; i < cells.size(); ++i) {
    require(static_cast<int>(cells[i].size()) == node_count(cells.type[i]), source, ": cell ", i, " has ",
            cells[i].size(), " nodes, its type needs ", node_count(cells.type[i]));
    std::vector<int> nodes(cells[i].begin(), cells[i].end());
    std::sort(nodes.begin(), nodes.end());
    require(nodes.front() >= 0 && nodes.back() < mesh.n_nodes(), source, ": cell ", i,
            " names a node outside 0..", mesh.n_nodes() - 1);
    require(std::adjacent_find(nodes.begin(), nodes.end()) == nodes.end(), source, ": cell ", i,
            " repeats a node");
  }
}

}  // namespace

void Cells::add(CellType t, std::span<const int> cell_nodes) {
  type.push_back(t);
  nodes.insert(nodes.end(), cell_nodes.begin(), cell_nodes.end());
  offset.push_back(static_cast<int>(nodes.size()));
}

std::vector<Face> boundary_faces(const Mesh& mesh, std::vector<int>* cell) {
  const FaceMap count = count_faces(mesh);
  std::vector<Face> boundary;
  for (int i = 0; i < mesh.cells.size(); ++i)
    for (const Face& face : cell_faces(mesh.cells.type[i], mesh.cells[i]))
      if (count.at(face_key(face)) == 1) {
        boundary.push_back(face);
        if (cell) cell->push_back(i);
      }
  return boundary;
}

void validate(const Mesh& mesh, const std::string& source) {
  for (int i = 0; i < mesh.n_nodes(); ++i)
    require(mesh.X.col(i).allFinite(), source, ": node ", i, " has coordinates (", mesh.X.col(i).transpose(),
            "), must be finite");
  validate_cells(mesh, source);
  validate_members(mesh.node_sets, mesh.n_nodes(), "node", source);
  validate_members(mesh.cell_sets, mesh.cells.size(), "cell", source);
  if (mesh.face_sets.empty()) return;
  const FaceMap faces = count_faces(mesh);
  for (const auto& [name, members] : mesh.face_sets)
    for (const Face& face : members)
      require(faces.contains(face_key(face)), source, ": face set '", name, "' holds the face (", face[0],
              ", ", face[1], ", ", face[2], ", ", face[3], "), which is no face of a cell");
}

const std::vector<int>& node_set(const Mesh& mesh, const std::string& name) {
  return named(mesh.node_sets, name, "node");
}
const std::vector<int>& cell_set(const Mesh& mesh, const std::string& name) {
  return named(mesh.cell_sets, name, "cell");
}
const std::vector<Face>& face_set(const Mesh& mesh, const std::string& name) {
  return named(mesh.face_sets, name, "face");
}

}  // namespace elastogear::mesh
