#include "elastogear/mesh/mesh.h"

#include <algorithm>
#include <numeric>

#include "elastogear/base/error.h"
#include "elastogear/base/text.h"

namespace elastogear::mesh {
namespace {

template <class Set>
const Set& named(const std::map<std::string, Set>& sets, const std::string& name, const char* kind) {
  const auto found = sets.find(name);
  if (found != sets.end()) return found->second;
  fail("the mesh has no ", kind, " set '", name, "'; it has: ", sets.empty() ? "none" : join_keys(sets));
}

std::string numbered(const char* kind, const std::vector<std::int64_t>& numbers, int i) {
  const auto at = static_cast<std::size_t>(i);
  if (at >= numbers.size()) return std::string(kind) + " " + std::to_string(i) + " (counted from 0)";
  return std::string(kind) + " " + std::to_string(numbers[at]);
}

// The faces of all cells, grouped by their lowest node.
class FaceIndex {
 public:
  explicit FaceIndex(const Mesh& mesh) : begin_(static_cast<std::size_t>(mesh.n_nodes()) + 1, 0) {
    std::vector<Face> all;
    all.reserve(static_cast<std::size_t>(mesh.cells.size()) * 6);
    for (int i = 0; i < mesh.cells.size(); ++i)
      for (const Face& face : cell_faces(mesh.cells.type[i], mesh.cells[i])) all.push_back(face_key(face));
    for (const Face& key : all) ++begin_[static_cast<std::size_t>(key[0]) + 1];
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    keys_.resize(all.size());
    std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
    for (const Face& key : all) keys_[next[static_cast<std::size_t>(key[0])]++] = key;
  }

  /// How many cells have it.
  int count(const Face& key) const {
    const auto first = static_cast<std::size_t>(key[0]);
    if (key[0] < 0 || first + 1 >= begin_.size()) return 0;
    const auto begin = keys_.begin();
    return static_cast<int>(std::count(begin + static_cast<std::ptrdiff_t>(begin_[first]),
                                       begin + static_cast<std::ptrdiff_t>(begin_[first + 1]), key));
  }

 private:
  std::vector<std::size_t> begin_;  // by the lowest node
  std::vector<Face> keys_;
};

void validate_members(const std::map<std::string, std::vector<int>>& sets, int n, const char* kind,
                      const std::string& source) {
  for (const auto& [name, members] : sets)
    for (int i : members)
      require(i >= 0 && i < n, source, ": ", kind, " set '", name, "' names ", kind, " ", i,
              ", allowed are 0..", n - 1);
}

void validate_cell(const Mesh& mesh, int i, const std::string& source) {
  const Cells& cells = mesh.cells;
  if (static_cast<int>(cells[i].size()) != node_count(cells.type[i]))
    fail(source, ": ", cell_text(mesh, i), " has ", cells[i].size(), " nodes, its type needs ",
         node_count(cells.type[i]));
  std::vector<int> nodes(cells[i].begin(), cells[i].end());
  std::sort(nodes.begin(), nodes.end());
  if (nodes.front() < 0 || nodes.back() >= mesh.n_nodes())
    fail(source, ": ", cell_text(mesh, i), " names a node outside 0..", mesh.n_nodes() - 1);
  const auto twin = std::adjacent_find(nodes.begin(), nodes.end());
  if (twin != nodes.end())
    fail(source, ": ", cell_text(mesh, i), " repeats a node, ", node_text(mesh, *twin));
}

void validate_cells(const Mesh& mesh, const std::string& source) {
  const Cells& cells = mesh.cells;
  require(cells.offset.size() == cells.type.size() + 1 &&
              cells.offset.back() == static_cast<int>(cells.nodes.size()),
          source, ": cell table is inconsistent");
  for (int i = 0; i < cells.size(); ++i) validate_cell(mesh, i, source);
}

}  // namespace

std::string node_text(const Mesh& mesh, int node) { return numbered("node", mesh.node_number, node); }
std::string cell_text(const Mesh& mesh, int cell) { return numbered("cell", mesh.cell_number, cell); }

std::string face_text(const Mesh& mesh, const Face& face) {
  std::string text;
  for (std::size_t i = 0; i < (face[3] == face[2] ? 3u : 4u); ++i)
    text += (i == 0 ? "" : ", ") + node_text(mesh, face[i]);
  return text;
}

void Cells::add(CellType t, std::span<const int> cell_nodes) {
  type.push_back(t);
  nodes.insert(nodes.end(), cell_nodes.begin(), cell_nodes.end());
  offset.push_back(static_cast<int>(nodes.size()));
}

std::vector<Face> boundary_faces(const Mesh& mesh, std::vector<int>* cell) {
  const FaceIndex index(mesh);
  std::vector<Face> boundary;
  for (int i = 0; i < mesh.cells.size(); ++i)
    for (const Face& face : cell_faces(mesh.cells.type[i], mesh.cells[i]))
      if (index.count(face_key(face)) == 1) {
        boundary.push_back(face);
        if (cell) cell->push_back(i);
      }
  return boundary;
}

void validate(const Mesh& mesh, const std::string& source) {
  for (int i = 0; i < mesh.n_nodes(); ++i)
    if (!mesh.X.col(i).allFinite())
      fail(source, ": ", node_text(mesh, i), " has coordinates (", mesh.X.col(i).transpose(),
           "), must be finite");
  validate_cells(mesh, source);
  validate_members(mesh.node_sets, mesh.n_nodes(), "node", source);
  validate_members(mesh.cell_sets, mesh.cells.size(), "cell", source);
  if (mesh.face_sets.empty()) return;
  const FaceIndex index(mesh);
  for (const auto& [name, members] : mesh.face_sets)
    for (const Face& face : members)
      if (index.count(face_key(face)) == 0)
        fail(source, ": face set '", name, "' holds the face of ", face_text(mesh, face),
             ", which is no face of a cell");
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
