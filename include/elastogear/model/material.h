#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "elastogear/model/viscoelastic.h"

namespace elastogear::model {

/// Directions of the material's axes 1, 2, 3 in the body frame.
struct Orientation {
  /// rectangular: 1 along axis_1, 2 in the plane of axis_1 and axis_2. cylindrical: radial, tangential and
  /// axial about the line through `origin` along `axis`, at each point of the body.
  enum class System { rectangular, cylindrical };
  System system = System::rectangular;
  Eigen::Vector3d axis_1 = Eigen::Vector3d::UnitX(), axis_2 = Eigen::Vector3d::UnitY();
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  /// rad, rotation vector in the axes so far that turns them into the material's: the angle of a winding
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();
};

/// Orthotropic linear elasticity by its engineering constants: eps_11 = sigma_11/E_1 - nu_12 sigma_22/E_1 -
/// ..., eps_22 = -nu_12 sigma_11/E_1 + ..., gamma_12 = sigma_12/G_12.
struct Orthotropic {
  Eigen::Vector3d E = Eigen::Vector3d::Zero();   ///< Pa, E_1 E_2 E_3
  Eigen::Vector3d nu = Eigen::Vector3d::Zero();  ///< -, nu_12 nu_13 nu_23
  Eigen::Vector3d G = Eigen::Vector3d::Zero();   ///< Pa, G_12 G_13 G_23
  Orientation orientation = {};
};

/// Shares of shear and bulk modulus, 0 to 1.
struct ModuliShares {
  double shear = 0, bulk = 0;

  bool empty() const { return shear == 0 && bulk == 0; }
};

/// Linear elasticity and density. E and nu hold for isotropic materials only. The moduli of a viscoelastic
/// material are its instantaneous ones.
struct Material {
  double E = 0;                                             ///< Pa, Young's modulus
  double nu = 0;                                            ///< -, Poisson's ratio
  double rho = 0;                                           ///< kg/m^3, density
  std::optional<Orthotropic> orthotropic = std::nullopt;    ///< set: takes the place of E and nu
  std::optional<Viscoelastic> viscoelastic = std::nullopt;  ///< set: the moduli relax
  ModuliShares relaxed = {};  ///< what of the moduli is gone in the stiffness of cells, which alone reads it
};

/// The material whose long-term moduli those of the given one are: with the instantaneous moduli of its Prony
/// series, which must be valid. docs/theory, Eq. (1.10).
Material from_long_term(Material material);

/// A material and the cell set it fills; the empty name stands for all cells that no other region names.
struct MaterialRegion {
  std::string cell_set;
  Material material;
};

/// hex8: plain isoparametric, with the nine incompatible modes of Taylor, Beresford & Wilson (1976), or with
/// the mean dilatation of Hughes (1980). Other cells have one formulation each.
enum class Element { incompatible, plain, bbar };

/// Shape functions in the mass of incompatible hex8: those of the nodes alone, or with the incompatible modes
/// that the static condensation of the stiffness adds to them. docs/theory, Eq. (1.5b).
enum class ElementMass { compatible, condensed };

/// How the stiffness and the mass of cells are computed.
struct Formulation {
  Element element = Element::incompatible;
  ElementMass mass = ElementMass::compatible;
};

}  // namespace elastogear::model
