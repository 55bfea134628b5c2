#pragma once

#include <string>
#include <vector>

namespace elastogear::model {

/// Isotropic linear elasticity.
struct Material {
  double E = 0;    ///< Pa, Young's modulus
  double nu = 0;   ///< -, Poisson's ratio
  double rho = 0;  ///< kg/m^3, density
};

/// A material and the cell set it fills; the empty name stands for all cells that no other region names.
struct MaterialRegion {
  std::string cell_set;
  Material material;
};

/// hex8: plain isoparametric, with the nine incompatible modes of Taylor, Beresford & Wilson (1976), or with
/// the mean dilatation of Hughes (1980). Other cells have one formulation each.
enum class Element { incompatible, plain, bbar };

}  // namespace elastogear::model
