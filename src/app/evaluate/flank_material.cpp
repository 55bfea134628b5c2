#include "app/evaluate/flank_material.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "elastogear/fem/material.h"
#include "elastogear/io/body_file.h"

namespace elastogear::app {

double surface_compliance(const std::string& file, const model::Surface& surface) {
  constexpr int kFace = 3;  // nodes, at least
  const io::BodySource source = io::read_body_source(file);
  if (source.regions.empty() || source.mesh.cells.size() == 0) return 0;
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
    if (found >= 0 && here != found) return 0;
    found = here;
  }
  if (found < 0) return 0;
  const model::Material& m = source.regions[static_cast<std::size_t>(found)].material;
  return m.orthotropic || m.viscoelastic ? 0 : (1 - m.nu * m.nu) / m.E;
}

}  // namespace elastogear::app
