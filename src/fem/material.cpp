#include "elastogear/fem/material.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>

#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"

namespace elastogear::fem {
namespace {

using model::Orientation;
using Vector6 = Eigen::Matrix<double, 6, 1>;

std::string label(const model::MaterialRegion& region) {
  return region.cell_set.empty() ? "material" : "material of cell set '" + region.cell_set + "'";
}

// Compliance of the normal strains in the material's axes. docs/theory, Eq. (1.7).
Eigen::Matrix3d normal_compliance(const model::Orthotropic& m) {
  Eigen::Matrix3d S = m.E.cwiseInverse().asDiagonal();
  S(0, 1) = S(1, 0) = -m.nu(0) / m.E(0);
  S(0, 2) = S(2, 0) = -m.nu(1) / m.E(0);
  S(1, 2) = S(2, 1) = -m.nu(2) / m.E(1);
  return S;
}

Matrix6 material_stiffness(const model::Orthotropic& m) {
  Matrix6 H = Matrix6::Zero();
  H.topLeftCorner<3, 3>() = normal_compliance(m).inverse();
  H.diagonal().tail<3>() << m.G(0), m.G(2), m.G(1);
  return H;
}

// Strains in the axes R per strain in the body frame, docs/theory, Eq. (1.8).
Matrix6 strain_rotation(const Eigen::Matrix3d& R) {
  Matrix6 T;
  for (int k = 0; k < 6; ++k) {
    const Vector6 e = Vector6::Unit(k);
    Eigen::Matrix3d eps;
    eps << e(0), e(3) / 2, e(5) / 2, e(3) / 2, e(1), e(4) / 2, e(5) / 2, e(4) / 2, e(2);
    const Eigen::Matrix3d in_axes = R.transpose() * eps * R;
    T.col(k) << in_axes.diagonal(), 2 * in_axes(0, 1), 2 * in_axes(1, 2), 2 * in_axes(0, 2);
  }
  return T;
}

Eigen::Matrix3d rectangular_axes(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  Eigen::Matrix3d R;
  R.col(0) = a.normalized();
  R.col(2) = a.cross(b).normalized();
  R.col(1) = R.col(2).cross(R.col(0));
  return R;
}

void validate_orientation(const Orientation& o, const std::string& region) {
  const bool rectangular = o.system == Orientation::System::rectangular;
  const double size = rectangular ? o.axis_1.normalized().cross(o.axis_2.normalized()).norm() : o.axis.norm();
  constexpr double kParallel = 1e-6;
  require(std::isfinite(size) && size > (rectangular ? kParallel : 0), region, ": ",
          rectangular ? "the first two axes are zero or parallel" : "the axis is zero");
  require(o.origin.allFinite() && o.rotation.allFinite(), region, ": the orientation is not finite");
}

void validate_orthotropic(const model::Orthotropic& m, const std::string& region) {
  const Eigen::IOFormat row(Eigen::StreamPrecision, Eigen::DontAlignCols, ", ", ", ");
  const bool finite = m.E.allFinite() && m.nu.allFinite() && m.G.allFinite();
  require(finite && m.E.minCoeff() > 0 && m.G.minCoeff() > 0, region, ": E = (", m.E.format(row),
          ") Pa, G = (", m.G.format(row), ") Pa, must be positive, and nu = (", m.nu.format(row), ") finite");
  require(normal_compliance(m).llt().info() == Eigen::Success, region, ": E = (", m.E.format(row),
          ") Pa with nu = (", m.nu.format(row),
          ") is not positive definite: |nu_ij| must be less than sqrt(E_i/E_j), and 1 - nu_12 nu_21 - ",
          "nu_23 nu_32 - nu_31 nu_13 - 2 nu_21 nu_32 nu_13 positive");
  validate_orientation(m.orientation, region);
}

void validate_relaxation(const model::MaterialRegion& region) {
  const model::Viscoelastic& viscoelastic = *region.material.viscoelastic;
  model::validate(viscoelastic, label(region));
  require(
      !region.material.orthotropic || viscoelastic.has_constant_ratio(), label(region),
      ": all moduli of an orthotropic material relax alike: give its Prony series by prony, not by prony_g "
      "and prony_k");
}

}  // namespace

Lame lame(const model::Material& material) {
  require(!material.orthotropic, "an orthotropic material has no Lame constants");
  const double E = material.E, nu = material.nu;
  return {E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))};
}

Elasticity elasticity(const model::Material& material) {
  if (!material.orthotropic) return lame(material);
  return Orthotropy{material_stiffness(*material.orthotropic), material.orthotropic->orientation};
}

Elasticity elasticity(const model::Material& material, model::ModulusPart part) {
  if (part == model::ModulusPart::both) return elasticity(material);
  const auto [lambda, mu] = lame(material);
  if (part == model::ModulusPart::shear) return Lame{-2.0 / 3 * mu, mu};
  return Lame{lambda + 2.0 / 3 * mu, 0};
}

Elasticity relaxed_elasticity(const model::Material& material) {
  const auto [shear, bulk] = material.relaxed;
  if (material.orthotropic) {
    require(shear == bulk, "all moduli of an orthotropic material relax alike");
    return Orthotropy{(1 - shear) * material_stiffness(*material.orthotropic),
                      material.orthotropic->orientation};
  }
  const auto [lambda, mu] = lame(material);
  const double kappa = (1 - bulk) * (lambda + 2.0 / 3 * mu);
  return Lame{kappa - 2.0 / 3 * (1 - shear) * mu, (1 - shear) * mu};
}

Eigen::Matrix3d material_axes(const Orientation& o, const Eigen::Vector3d& x) {
  const Eigen::Matrix3d turned = rotation_matrix(o.rotation);
  if (o.system == Orientation::System::rectangular) return rectangular_axes(o.axis_1, o.axis_2) * turned;
  const Eigen::Vector3d axis = o.axis.normalized(), d = x - o.origin, radius = d - axis * axis.dot(d);
  const bool on_axis = radius.isZero(0);
  const Eigen::Vector3d r = on_axis ? axis.unitOrthogonal() : radius;
  return rectangular_axes(r, axis.cross(r)) * turned;
}

std::vector<Matrix6> elasticity_at(const Orthotropy& material, const Eigen::Matrix3Xd& x) {
  std::vector<Matrix6> H;
  const bool uniform = material.orientation.system == Orientation::System::rectangular;
  for (Eigen::Index p = 0; p < x.cols(); ++p) {
    if (uniform && p > 0) {
      H.push_back(H.front());
      continue;
    }
    const Matrix6 T = strain_rotation(material_axes(material.orientation, x.col(p)));
    H.push_back(T.transpose() * material.H * T);
  }
  return H;
}

Matrix6 elasticity_matrix(const model::Material& material, const Eigen::Vector3d& x) {
  if (material.orthotropic) return elasticity_at(std::get<Orthotropy>(elasticity(material)), x).front();
  const auto [lambda, mu] = lame(material);
  Matrix6 H = Matrix6::Zero();
  H.diagonal() << 2 * mu, 2 * mu, 2 * mu, mu, mu, mu;
  H.topLeftCorner<3, 3>().array() += lambda;
  return H;
}

double youngs_modulus(const model::Material& material, const Eigen::Vector3d& n, const Eigen::Vector3d& x) {
  if (!material.orthotropic) return material.E;
  const auto H = elasticity_at(std::get<Orthotropy>(elasticity(material)), x);
  const Eigen::Vector3d d = n.normalized();
  const Vector6 s{d.x() * d.x(), d.y() * d.y(), d.z() * d.z(), d.x() * d.y(), d.y() * d.z(), d.x() * d.z()};
  return 1 / s.dot(H.front().ldlt().solve(s));
}

Lame mean_lame(const model::Material& material) {
  if (!material.orthotropic) return lame(material);
  const Vector6 moduli = material_stiffness(*material.orthotropic).diagonal();
  const double mu = moduli.tail<3>().mean();
  return {moduli.head<3>().mean() - 2 * mu, mu};
}

void validate(const std::vector<model::MaterialRegion>& regions) {
  require(!regions.empty(), "no material given");
  for (const auto& region : regions) {
    const auto& [E, nu, rho, orthotropic, viscoelastic, relaxed] = region.material;
    require(std::isfinite(rho) && rho > 0, label(region), ": rho = ", rho, " kg/m^3, must be positive");
    if (viscoelastic) validate_relaxation(region);
    if (orthotropic) {
      validate_orthotropic(*orthotropic, label(region));
      continue;
    }
    require(std::isfinite(E) && E > 0, label(region), ": E = ", E, " Pa, must be positive");
    require(nu > -1 && nu < 0.5, label(region), ": nu = ", nu, ", must lie between -1 and 0.5 (exclusive)");
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
      if (region_of[cell] >= 0 && region_of[cell] != r)
        fail(mesh::cell_text(mesh, cell), " is in cell sets '", regions[r].cell_set, "' and '",
             regions[region_of[cell]].cell_set, "', which both have a material");
      region_of[cell] = r;
    }
  }
  for (int cell = 0; cell < mesh.cells.size(); ++cell) {
    if (region_of[cell] < 0) region_of[cell] = rest;
    if (region_of[cell] < 0) fail(mesh::cell_text(mesh, cell), " has no material");
  }
  return region_of;
}

}  // namespace elastogear::fem
