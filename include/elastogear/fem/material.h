#pragma once
// Materials of a mesh: which cell has which, and what elements need of them (docs/theory, section
// 1.3).

#include <Eigen/Core>
#include <variant>
#include <vector>

#include "elastogear/mesh/mesh.h"
#include "elastogear/model/material.h"

namespace elastogear::fem {

/// Lame constants, Pa: sigma = lambda tr(eps) I + 2 mu eps.
struct Lame {
  double lambda = 0, mu = 0;
};
/// Lame constants of an isotropic material. Error for orthotropic materials.
Lame lame(const model::Material& material);

/// H of sigma = H eps, Pa, order xx yy zz xy yz xz; shear strains are gamma = 2 eps.
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// H in the material's axes, and where these point.
struct Orthotropy {
  Matrix6 H;
  model::Orientation orientation;
};

/// Elasticity as elements need it. Isotropic materials have shorter formulas of their own.
using Elasticity = std::variant<Lame, Orthotropy>;
Elasticity elasticity(const model::Material& material);
/// The part of it by the shear or the bulk modulus alone. Error for these parts of an orthotropic material.
Elasticity elasticity(const model::Material& material, model::ModulusPart part);

/// What is left of it without the shares material.relaxed. Error where these differ in an orthotropic
/// material.
Elasticity relaxed_elasticity(const model::Material& material);

/// The material's axes at the point x (m), as columns. On the axis of a cylindrical system axis 1 is any
/// radius.
Eigen::Matrix3d material_axes(const model::Orientation& orientation, const Eigen::Vector3d& x);

/// H in the body frame at each of the points x, 3 x n, m. Eq. (1.8).
std::vector<Matrix6> elasticity_at(const Orthotropy& material, const Eigen::Matrix3Xd& x);

/// H in the body frame at the point x (m), Pa, of any material.
Matrix6 elasticity_matrix(const model::Material& material, const Eigen::Vector3d& x);

/// Young's modulus E_n in the direction n at the point x (m), Pa (section 1.3).
double youngs_modulus(const model::Material& material, const Eigen::Vector3d& n, const Eigen::Vector3d& x);

/// lame() of an isotropic material; of an orthotropic one with the mean moduli of compression and shear waves
/// along its axes, for estimates.
Lame mean_lame(const model::Material& material);

/// Throws Error (naming the region) unless every region's density is positive and its elasticity positive
/// definite (isotropic: E > 0, -1 < nu < 0.5), and stays so while it relaxes.
void validate(const std::vector<model::MaterialRegion>& regions);

/// Index into `regions` of every cell. The region with the empty name takes the cells that no other names.
/// Throws Error for an unknown set, a cell in two regions, a cell in none, two regions of one name.
std::vector<int> cell_regions(const mesh::Mesh& mesh, const std::vector<model::MaterialRegion>& regions);

}  // namespace elastogear::fem
