#include <algorithm>

#include "io/hdf5/schema.h"

namespace elastogear::io {
namespace {

template <class Set, class Write>
void write_sets(const h5::File& file, const std::string& group, const std::map<std::string, Set>& sets,
                const Write& write) {
  h5::make_group(file, group);
  for (const auto& [name, members] : sets) {
    require_name(file, name);
    h5::write<int>(file, group + "/" + name, write(members), "1");
  }
}

h5::View<int> faces(const std::vector<mesh::Face>& set) {
  return {{set.size(), 4}, set.empty() ? nullptr : set.front().data()};
}

std::vector<mesh::Face> read_faces(const h5::File& file, const std::string& name) {
  const auto numbers = h5::read<int>(file, name, {h5::kAny, 4});
  std::vector<mesh::Face> set(numbers.size() / 4);
  for (std::size_t i = 0; i < set.size(); ++i) std::copy_n(&numbers[4 * i], 4, set[i].begin());
  return set;
}

std::map<std::string, std::vector<int>> read_sets(const h5::File& file, const std::string& group) {
  std::map<std::string, std::vector<int>> sets;
  for (const std::string& name : h5::members(file, group))
    sets[name] = h5::read<int>(file, group + "/" + name, {h5::kAny});
  return sets;
}

}  // namespace

void write_mesh(const h5::File& file, const mesh::Mesh& mesh) {
  h5::write<double>(file, "/mesh/X", view(mesh.X), "m");
  std::vector<int> types;
  for (mesh::CellType type : mesh.cells.type) types.push_back(static_cast<int>(type));
  h5::write<int>(file, "/mesh/cell_type", view(types), "1");
  for (int type = 0; type < mesh::kCellTypes; ++type)
    h5::set_attribute(file, "/mesh/cell_type", "type_" + std::to_string(type),
                      mesh::name(static_cast<mesh::CellType>(type)));
  h5::write<int>(file, "/mesh/cell_offset", view(mesh.cells.offset), "1");
  h5::write<int>(file, "/mesh/cell_nodes", view(mesh.cells.nodes), "1");
  const auto numbers = [](const std::vector<int>& set) { return view(set); };
  write_sets(file, "/mesh/node_sets", mesh.node_sets, numbers);
  write_sets(file, "/mesh/cell_sets", mesh.cell_sets, numbers);
  write_sets(file, "/mesh/face_sets", mesh.face_sets, faces);
}

mesh::Mesh read_mesh(const h5::File& file) {
  mesh::Mesh mesh;
  mesh.X = read_points(file, "/mesh/X");
  for (int type : h5::read<int>(file, "/mesh/cell_type", {h5::kAny})) {
    require(type >= 0 && type < mesh::kCellTypes, file.path, ": /mesh/cell_type holds ", type,
            ", allowed are 0..", mesh::kCellTypes - 1);
    mesh.cells.type.push_back(static_cast<mesh::CellType>(type));
  }
  mesh.cells.offset = h5::read<int>(file, "/mesh/cell_offset", {mesh.cells.type.size() + 1});
  mesh.cells.nodes = h5::read<int>(file, "/mesh/cell_nodes", {h5::kAny});
  const auto& offset = mesh.cells.offset;
  require(offset.front() == 0 && std::is_sorted(offset.begin(), offset.end()), file.path,
          ": /mesh/cell_offset does not ascend from 0");
  mesh.node_sets = read_sets(file, "/mesh/node_sets");
  mesh.cell_sets = read_sets(file, "/mesh/cell_sets");
  for (const std::string& name : h5::members(file, "/mesh/face_sets"))
    mesh.face_sets[name] = read_faces(file, "/mesh/face_sets/" + name);
  mesh::validate(mesh, file.path);
  return mesh;
}

}  // namespace elastogear::io
