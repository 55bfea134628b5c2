#include "elastogear/fem/material.h"

#include "elastogear/base/error.h"

namespace elastogear::fem {
namespace {

std::string label(const model::MaterialRegion& region) {
  return region.cell_set.empty() ? "material" : "material of cell set '" + region.cell_set + "'";
}

}  // namespace

Lame lame(const model::Material& material) {
  const double E = material.E, nu = material.nu;
  return {E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))};
}

void validate(const std::vector<model::MaterialRegion>& regions) {
  require(!regions.empty(), "no material given");
  for (const auto& region : regions) {
    const auto& [E, nu, rho] = region.material;
    require(std::isfinite(E) && E > 0, label(region), ": E = ", E, " Pa, must be positive");
    require(nu > -1 && nu < 0.5, label(region), ": nu = ", nu, ", must lie between -1 and 0.5 (exclusive)");
    require(std::isfinite(rho) && rho > 0, label(region), ": rho = ", rho, " kg/m^3, must be positive");
  }
}

std::vector<int> cell_regions(const mesh::Mesh& mesh, const std::vector<model::MaterialRegion>& regions) {
  std::vector<int> region_of(static_cast<std::size_t>(mesh.cells.size()), -1);
  int rest = -1;
  for (int r = 0; r < static_cast<int>(regions.size()); ++r) {
    if (regions[r].cell_set.empty()) {
      require(rest < 0, "two materials for the cells outside all named cell sets");
      rest = r;
      continue;
    }
    for (int cell : mesh::cell_set(mesh, regions[r].cell_set)) {
      require(region_of[cell] < 0 || region_of[cell] == r, "cell ", cell,
              " (counted from 0) is in cell sets '", regions[r].cell_set, "' and '",
              regions[std::max(0, region_of[cell])].cell_set, "', which both have a material");
      region_of[cell] = r;
    }
  }
  for (int cell = 0; cell < mesh.cells.size(); ++cell) {
    if (region_of[cell] < 0) region_of[cell] = rest;
    require(region_of[cell] >= 0, "cell ", cell, " (counted from 0) has no material");
  }
  return region_of;
}

}  // namespace elastogear::fem
