#include <algorithm>

#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "elastogear/base/number.h"
#include "mesh/msh/msh.h"
#include "mesh/msh/msh_format.h"

namespace elastogear::mesh {
namespace {

using namespace msh_format;

int gmsh_type(CellType type) {
  const auto* const found = std::find_if(std::begin(kTypes), std::end(kTypes),
                                         [type](const ElementType& t) { return t.cell == type; });
  return found->number;
}

// Collects the file's content; numbers go out as text or as bytes.
struct Out {
  bool binary = false;
  std::string text;

  template <class T>
  void put(T value) {
    if (binary) {
      text.append(reinterpret_cast<const char*>(&value), sizeof value);
    } else {
      print(text, value);
      text += ' ';
    }
  }
  void integer(int value) { put<std::int32_t>(value); }
  void size(std::size_t value) { put<std::uint64_t>(value); }
  void real(double value) { put(value); }
  void end_line() {
    if (!binary) text.back() = '\n';
  }
  void begin(const std::string& section) { text += "$" + section + "\n"; }
  void end(const std::string& section) { text += (binary ? "\n$End" : "$End") + section + "\n"; }
};

// Cells that lie in the same cell sets make up one volume.
struct Volume {
  std::vector<int> sets;  // numbers of cell sets, in the order of the map
  std::vector<int> cells;
};

std::vector<Volume> volumes(const Mesh& mesh) {
  std::vector<std::vector<int>> sets_of(mesh.cells.size());
  int number = 0;
  for (const auto& [name, cells] : mesh.cell_sets) {
    for (int cell : cells) sets_of[cell].push_back(number);
    ++number;
  }
  std::map<std::vector<int>, std::vector<int>> by_sets;
  // An empty set keeps its place in the file by a volume without cells.
  for (int set = 0; const auto& [name, cells] : mesh.cell_sets) {
    if (cells.empty()) by_sets[{set}];
    ++set;
  }
  for (int cell = 0; cell < mesh.cells.size(); ++cell) by_sets[sets_of[cell]].push_back(cell);
  std::vector<Volume> result;
  for (auto& [sets, cells] : by_sets) result.push_back({sets, std::move(cells)});
  return result;
}

template <class Set>
void write_names(Out& out, int dim, const std::map<std::string, Set>& sets) {
  int tag = 0;
  for (const auto& [name, members] : sets) {
    require(name.find_first_of("\"\r\n") == std::string::npos, "set name '", name,
            "' holds a double quote or a line end, which .msh cannot store");
    out.text += std::to_string(dim) + " " + std::to_string(++tag) + " \"" + name + "\"\n";
  }
}

void write_physical_names(Out& out, const Mesh& mesh) {
  out.begin("PhysicalNames");
  out.text += std::to_string(mesh.node_sets.size() + mesh.face_sets.size() + mesh.cell_sets.size()) + "\n";
  write_names(out, 0, mesh.node_sets);
  write_names(out, 2, mesh.face_sets);
  write_names(out, 3, mesh.cell_sets);
  out.text += "$EndPhysicalNames\n";
}

// One surface or volume: its number, the mesh's bounding box, its physical groups, no bounding entities.
void write_entity(Out& out, int tag, const Mesh& mesh, const std::vector<int>& sets) {
  out.integer(tag);
  for (const Eigen::Vector3d& corner :
       {Eigen::Vector3d(mesh.X.rowwise().minCoeff()), Eigen::Vector3d(mesh.X.rowwise().maxCoeff())})
    for (double x : corner) out.real(x);
  out.size(sets.size());
  for (int set : sets) out.integer(set + 1);
  out.size(0);
  out.end_line();
}

void write_point(Out& out, int tag, const Eigen::Vector3d& X) {
  out.integer(tag);
  for (double x : X) out.real(x);
  out.size(1);
  out.integer(tag);
  out.end_line();
}

void write_entities(Out& out, const Mesh& mesh, const std::vector<Volume>& volume) {
  out.begin("Entities");
  for (std::size_t n : {mesh.node_sets.size(), std::size_t{0}, mesh.face_sets.size(), volume.size()})
    out.size(n);
  out.end_line();
  int tag = 0;
  for (const auto& [name, nodes] : mesh.node_sets)
    write_point(out, ++tag, mesh.X.col(nodes.empty() ? 0 : nodes.front()));
  const int n_surfaces = static_cast<int>(mesh.face_sets.size());
  for (int surface = 0; surface < n_surfaces; ++surface) write_entity(out, surface + 1, mesh, {surface});
  tag = 0;
  for (const Volume& v : volume) write_entity(out, ++tag, mesh, v.sets);
  out.end("Entities");
}

void write_head(Out& out, std::size_t blocks, std::size_t items) {
  for (std::size_t n : {blocks, items, std::size_t{1}, items}) out.size(n);
  out.end_line();
}

void write_block(Out& out, std::array<int, 3> dim_tag_type, std::size_t items) {
  for (int value : dim_tag_type) out.integer(value);
  out.size(items);
  out.end_line();
}

void write_nodes(Out& out, const Mesh& mesh) {
  out.begin("Nodes");
  write_head(out, 1, mesh.n_nodes());
  write_block(out, {3, 1, 0}, mesh.n_nodes());
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    out.size(i + 1);
    out.end_line();
  }
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    for (double x : mesh.X.col(i)) out.real(x);
    out.end_line();
  }
  out.end("Nodes");
}

struct Element {
  std::size_t tag;
  std::vector<int> nodes;  // in Gmsh's order
};

Element cell_element(const Mesh& mesh, int cell) {
  const auto nodes = mesh.cells[cell];
  const auto position = gmsh_position(mesh.cells.type[cell]);
  Element element{cell + std::size_t{1}, {nodes.begin(), nodes.end()}};
  for (std::size_t k = 0; k < position.size(); ++k) element.nodes[position[k]] = nodes[k];
  return element;
}

// The elements of one entity.
struct Block {
  int dim, entity, type;
  std::vector<Element> elements;
};

using Blocks = std::vector<Block>;

// Adds an element to the entity's block of its type.
void add(Blocks& blocks, const Block& head, Element element) {
  const auto same = [&](const Block& b) {
    return b.dim == head.dim && b.entity == head.entity && b.type == head.type;
  };
  auto found = std::find_if(blocks.rbegin(), blocks.rend(), same);
  if (found == blocks.rend()) {
    blocks.push_back(head);
    found = blocks.rbegin();
  }
  found->elements.push_back(std::move(element));
}

// Cells keep their number as tag, so that their order survives the grouping into volumes, and faces that in
// their set. Parts of a second-order cell's side are written as the linear faces they are.
Blocks element_blocks(const Mesh& mesh, const std::vector<Volume>& volume) {
  Blocks blocks;
  for (int entity = 0; const Volume& v : volume) {
    ++entity;
    for (int cell : v.cells)
      add(blocks, {3, entity, gmsh_type(mesh.cells.type[cell]), {}}, cell_element(mesh, cell));
  }
  std::size_t tag = mesh.cells.size();
  for (int entity = 0; const auto& [name, faces] : mesh.face_sets) {
    ++entity;
    for (const Face& face : faces) {
      const bool triangle = face[2] == face[3];
      add(blocks, {2, entity, triangle ? kTriangle : kQuadrangle, {}},
          {++tag, {face.begin(), face.end() - (triangle ? 1 : 0)}});
    }
  }
  for (int entity = 0; const auto& [name, nodes] : mesh.node_sets) {
    ++entity;
    for (int node : nodes) add(blocks, {0, entity, kPoint, {}}, {++tag, {node}});
  }
  return blocks;
}

void write_elements(Out& out, const Mesh& mesh, const std::vector<Volume>& volume) {
  const std::vector<Block> blocks = element_blocks(mesh, volume);
  std::size_t total = 0;
  for (const Block& block : blocks) total += block.elements.size();
  out.begin("Elements");
  write_head(out, blocks.size(), total);
  for (const Block& block : blocks) {
    write_block(out, {block.dim, block.entity, block.type}, block.elements.size());
    for (const Element& element : block.elements) {
      out.size(element.tag);
      for (int node : element.nodes) out.size(node + 1);
      out.end_line();
    }
  }
  out.end("Elements");
}

}  // namespace

void write_msh(const std::string& path, const Mesh& mesh, Encoding encoding) {
  validate(mesh, path);
  require(mesh.cells.size() > 0, path, ": the mesh has no cells");
  Out out;
  out.begin("MeshFormat");
  out.text += encoding == Encoding::binary ? "4.1 1 8\n" : "4.1 0 8\n";
  out.binary = encoding == Encoding::binary;
  if (out.binary) out.integer(1);
  out.end("MeshFormat");
  out.text += kSignature;
  write_physical_names(out, mesh);
  const std::vector<Volume> volume = volumes(mesh);
  write_entities(out, mesh, volume);
  write_nodes(out, mesh);
  write_elements(out, mesh, volume);
  write_file(path, out.text);
}

}  // namespace elastogear::mesh
