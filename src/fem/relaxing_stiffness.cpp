#include "elastogear/fem/relaxing_stiffness.h"

#include <algorithm>

#include "elastogear/base/sort_unique.h"
#include "elastogear/fem/element.h"

namespace elastogear::fem {
namespace {

bool relaxes(const std::vector<double>& relative) {
  return std::any_of(relative.begin(), relative.end(), [](double g) { return g > 0; });
}

// Displacements that share a cell of the region with each displacement.
Eigen::VectorXi neighbour_counts(const mesh::Mesh& mesh, const std::vector<int>& cells) {
  std::vector<std::vector<int>> neighbours(static_cast<std::size_t>(mesh.n_nodes()));
  for (int cell : cells)
    for (int a : mesh.cells[cell])
      neighbours[a].insert(neighbours[a].end(), mesh.cells[cell].begin(), mesh.cells[cell].end());
  Eigen::VectorXi counts(3 * mesh.n_nodes());
  for (int node = 0; node < mesh.n_nodes(); ++node) {
    sort_unique(neighbours[node]);
    counts.segment<3>(3 * node).setConstant(3 * static_cast<int>(neighbours[node].size()));
  }
  return counts;
}

}  // namespace

std::vector<RelaxingModuli> relaxing_moduli(const std::vector<model::MaterialRegion>& regions) {
  std::vector<RelaxingModuli> all;
  for (int r = 0; r < static_cast<int>(regions.size()); ++r) {
    const auto& viscoelastic = regions[r].material.viscoelastic;
    if (!viscoelastic) continue;
    const std::vector<double> tau = relaxation_times(*viscoelastic);
    if (viscoelastic->has_constant_ratio()) {
      all.push_back({r, model::ModulusPart::both, viscoelastic->g, tau});
      continue;
    }
    if (relaxes(viscoelastic->g)) all.push_back({r, model::ModulusPart::shear, viscoelastic->g, tau});
    if (relaxes(viscoelastic->k)) all.push_back({r, model::ModulusPart::bulk, viscoelastic->k, tau});
  }
  return all;
}

model::SparseRows relaxing_stiffness(const mesh::Mesh& mesh,
                                     const std::vector<model::MaterialRegion>& regions,
                                     const std::vector<int>& region, const RelaxingModuli& moduli,
                                     model::Element element) {
  const model::Material& material = regions[moduli.region].material;
  const Elasticity whole = elasticity(material), part = elasticity(material, moduli.part);
  std::vector<int> cells;
  for (int cell = 0; cell < mesh.cells.size(); ++cell)
    if (region[cell] == moduli.region) cells.push_back(cell);
  model::SparseRows K(3 * mesh.n_nodes(), 3 * mesh.n_nodes());
  K.reserve(neighbour_counts(mesh, cells));
  for (int cell : cells) {
    const auto nodes = mesh.cells[cell];
    const Eigen::MatrixXd K_e = element_functions(mesh.cells.type[cell])
                                    .stiffness_of_part(cell_coordinates(mesh, cell), whole, part, element);
    for (Eigen::Index r = 0; r < K_e.rows(); ++r)
      for (Eigen::Index c = 0; c < K_e.cols(); ++c)
        K.coeffRef(3 * nodes[r / 3] + r % 3, 3 * nodes[c / 3] + c % 3) += K_e(r, c);
  }
  K.makeCompressed();
  return K;
}

}  // namespace elastogear::fem
