#include "assembly.h"

#include <algorithm>

namespace elastogear::gear {

std::vector<mesh::Face> add_hex(mesh::Mesh& mesh, const std::array<int, 8>& nodes) {
  mesh.cells.add(mesh::CellType::hex8, nodes);
  return mesh::cell_faces(mesh::CellType::hex8, nodes);
}

void add_flank(mesh::Mesh& mesh, const mesh::Face& face, const std::string& tooth, const std::string& side) {
  for (const std::string& name : {std::string("flanks"), side, tooth + "_" + side})
    mesh.face_sets[name].push_back(face);
}

void sort_node_sets(mesh::Mesh& mesh) {
  for (auto& [name, nodes] : mesh.node_sets) {
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  }
}

std::string numbered(const std::string& prefix, int i, int n) {
  std::string digits = std::to_string(i + 1);
  digits.insert(0, std::to_string(n).size() - digits.size(), '0');
  return prefix + "_" + digits;
}

}  // namespace elastogear::gear
