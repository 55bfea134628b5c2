#include "elastogear/drive/surface_compliance.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "elastogear/fem/material.h"
#include "elastogear/io/body_file.h"
#include "elastogear/io/body_materials.h"

namespace elastogear::drive {

namespace {

double compliance(const model::Material& m) {
  return m.orthotropic || m.viscoelastic ? 0 : (1 - m.nu * m.nu) / m.E;
}

// The region of all cells that have a face on the surface; -1 when there are several or none.
int region_at(const model::Surface& surface, const io::BodySource& source) {
  constexpr int kFace = 3;  // nodes, at least
  std::vector<bool> at_surface(static_cast<std::size_t>(source.mesh.n_nodes()), false);
  for (int node : surface.node) at_surface[static_cast<std::size_t>(node)] = true;
  const std::vector<int> region = fem::cell_regions(source.mesh, source.regions);
  int found = -1;
  for (int cell = 0; cell < source.mesh.cells.size(); ++cell) {
    const auto nodes = source.mesh.cells[cell];
    if (std::count_if(nodes.begin(), nodes.end(),
                      [&](int n) { return at_surface[static_cast<std::size_t>(n)]; }) < kFace)
      continue;
    const int here = region[static_cast<std::size_t>(cell)];
    if (found >= 0 && here != found) return -1;
    found = here;
  }
  return found;
}

}  // namespace

double surface_compliance(const std::string& file, const model::Surface& surface) {
  const io::BodyMaterials materials = io::read_body_materials(file);
  if (materials.regions.empty() || !materials.has_cells || surface.face.cols() == 0) return 0;
  if (materials.regions.size() == 1 && materials.regions.front().cell_set.empty())
    return compliance(materials.regions.front().material);
  const io::BodySource source = io::read_body_source(file);
  const int region = region_at(surface, source);
  return region < 0 ? 0 : compliance(source.regions[static_cast<std::size_t>(region)].material);
}

}  // namespace elastogear::drive
