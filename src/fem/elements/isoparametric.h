#pragma once
// Plain isoparametric elements: everything but the shape functions and quadrature rules is the same for all.

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <vector>

#include "elastogear/fem/element.h"
#include "fem/elements/kernels.h"

namespace elastogear::fem {

/// Shape functions at the points of one quadrature rule.
struct Samples {
  Eigen::VectorXd w;                ///< weights
  Eigen::MatrixXd N;                ///< n_nodes x n_points
  std::vector<Eigen::MatrixXd> dN;  ///< per point n_nodes x 3

  int size() const { return static_cast<int>(dN.size()); }
};

/// Shape functions and quadrature of a cell type in reference coordinates.
struct ReferenceCell {
  Samples stiffness, mass, stress;
  Eigen::MatrixXd extrapolation;  ///< n_nodes x stress points: nodal values from those at the points
};

/// Tabulated once per type; Error for hex8, which has its own element.
const ReferenceCell& reference_cell(mesh::CellType type);

/// X: 3 x n_nodes. Smallest det J over the points of all three rules; m^3.
double smallest_jacobian(const ReferenceCell& cell, const Eigen::Matrix3Xd& X);
double volume(const ReferenceCell& cell, const Eigen::Matrix3Xd& X);
Eigen::MatrixXd mass(const ReferenceCell& cell, const Eigen::Matrix3Xd& X, double rho);

/// Gradients of the shape functions, 3 x n, and det J at one point.
template <int n>
Eigen::Matrix<double, 3, n> gradients(const Eigen::Matrix3Xd& X, const Eigen::MatrixXd& dN, double* det) {
  const Eigen::Matrix3d J = X * dN;
  *det = J.determinant();
  return J.inverse().transpose() * dN.transpose();
}

template <int n, int n_points>
Eigen::MatrixXd stiffness(const ReferenceCell& cell, const Eigen::Matrix3Xd& X, const Elasticity& material) {
  Eigen::Matrix<double, 3 * n, n_points> G;
  for (int p = 0; p < n_points; ++p) {
    double det = 0;
    const Eigen::Matrix<double, 3, n> g = gradients<n>(X, cell.stiffness.dN[p], &det);
    G.col(p) = std::sqrt(cell.stiffness.w(p) * det) * g.reshaped();
  }
  if (const Lame* isotropic = std::get_if<Lame>(&material))
    return isotropic_stiffness<n, n_points>(G, *isotropic);
  return general_stiffness<n, n_points>(G,
                                        elasticity_at(std::get<Orthotropy>(material), X * cell.stiffness.N));
}

template <int n>
Eigen::MatrixXd stress(const ReferenceCell& cell, const Eigen::Matrix3Xd& X, const Elasticity& material) {
  const Orthotropy* const orthotropy = std::get_if<Orthotropy>(&material);
  std::vector<Matrix6> H;
  if (orthotropy) H = elasticity_at(*orthotropy, X * cell.stress.N);
  Eigen::MatrixXd S = Eigen::MatrixXd::Zero(6 * n, 3 * n);
  for (int p = 0; p < cell.stress.size(); ++p) {
    double det = 0;
    const Eigen::Matrix<double, 3, n> g = gradients<n>(X, cell.stress.dN[p], &det);
    const Eigen::Matrix<double, 6, 3 * n> at_point =
        orthotropy ? H[p] * strains<n>(g) : isotropic_stress<n>(g, std::get<Lame>(material));
    for (int a = 0; a < n; ++a) S.middleRows(6 * a, 6) += cell.extrapolation(a, p) * at_point;
  }
  return S;
}

/// The table's row of a cell type with n nodes and n_points points in the stiffness rule.
template <mesh::CellType type, int n, int n_points>
constexpr ElementFunctions kIsoparametric = {
    n,
    [](const Eigen::Matrix3Xd& X) { return smallest_jacobian(reference_cell(type), X); },
    [](const Eigen::Matrix3Xd& X) { return volume(reference_cell(type), X); },
    [](const Eigen::Matrix3Xd& X, const Elasticity& material, model::Element) {
      return stiffness<n, n_points>(reference_cell(type), X, material);
    },
    [](const Eigen::Matrix3Xd& X, const Elasticity&, const Elasticity& part, model::Element) {
      return stiffness<n, n_points>(reference_cell(type), X, part);
    },
    [](const Eigen::Matrix3Xd& X, double rho) { return mass(reference_cell(type), X, rho); },
    [](const Eigen::Matrix3Xd& X, const Elasticity& material, model::Element) {
      return stress<n>(reference_cell(type), X, material);
    }};

}  // namespace elastogear::fem
