#include "elastogear/mesh/outer_sides.h"

#include <algorithm>

namespace elastogear::mesh {

std::vector<std::vector<int>> outer_sides(const Mesh& mesh) {
  std::vector<int> cell_of;
  const std::vector<Face> faces = boundary_faces(mesh, &cell_of);
  std::vector<std::vector<int>> outer;
  for (auto begin = faces.begin(), end = begin; begin != faces.end(); begin = end) {
    const int cell = cell_of[static_cast<std::size_t>(begin - faces.begin())];
    while (end != faces.end() && cell_of[static_cast<std::size_t>(end - faces.begin())] == cell) ++end;
    const auto cut = cell_sides(mesh.cells.type[cell], mesh.cells[cell]);
    const auto nodes = cell_side_nodes(mesh.cells.type[cell], mesh.cells[cell]);
    for (std::size_t side = 0; side < cut.size(); ++side)
      if (std::find(begin, end, cut[side][0]) != end) outer.push_back(nodes[side]);
  }
  return outer;
}

}  // namespace elastogear::mesh
