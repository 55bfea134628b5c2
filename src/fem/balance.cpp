#include "elastogear/fem/balance.h"

#include "elastogear/fem/element.h"
#include "fem/elements/cell_mass.h"

namespace elastogear::fem {
namespace {

using Eigen::MatrixXd;

MatrixXd rows_of_cell(const MatrixXd& u, std::span<const int> nodes) {
  MatrixXd rows(3 * static_cast<Eigen::Index>(nodes.size()), u.cols());
  for (std::size_t a = 0; a < nodes.size(); ++a)
    rows.middleRows<3>(3 * static_cast<Eigen::Index>(a)) = u.middleRows<3>(3 * nodes[a]);
  return rows;
}

// Inertia forces M_e u, without M_e where this is M_s (x) I_3.
MatrixXd inertia_forces(const CellMass& mass, const MatrixXd& u) {
  if (mass.has_modes()) return mass_matrix(mass) * u;
  const MatrixXd& M_s = mass.scalar;
  MatrixXd f(u.rows(), u.cols());
  for (Eigen::Index j = 0; j < u.cols(); ++j)
    f.col(j).reshaped(3, M_s.rows()) = u.col(j).reshaped(3, M_s.rows()) * M_s;
  return f;
}

}  // namespace

Eigen::VectorXd residual(const MeshedBody& body, const MatrixXd& u, const Eigen::VectorXd& lambda) {
  MatrixXd rest = MatrixXd::Zero(u.rows(), u.cols()), moduli = rest;
  for (int cell = 0; cell < body.mesh.cells.size(); ++cell) {
    const ElementFunctions& functions = element_functions(body.mesh.cells.type[cell]);
    const model::Material& material = body.regions[body.region[cell]].material;
    const Eigen::Matrix3Xd X = cell_coordinates(body.mesh, cell);
    const auto nodes = body.mesh.cells[cell];
    const MatrixXd u_e = rows_of_cell(u, nodes);
    const Elasticity elastic_moduli = elasticity(material);
    const MatrixXd elastic = functions.stiffness(X, elastic_moduli, body.formulation.element) * u_e;
    const CellMass mass =
        cell_mass(body.mesh.cells.type[cell], X, material.rho, elastic_moduli, body.formulation);
    const MatrixXd inertial = inertia_forces(mass, u_e) * lambda.asDiagonal();
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      if (!body.is_free[nodes[a]]) continue;
      const auto at = 3 * static_cast<Eigen::Index>(a);
      rest.middleRows<3>(3 * nodes[a]) += elastic.middleRows<3>(at) - inertial.middleRows<3>(at);
      moduli.middleRows<3>(3 * nodes[a]) +=
          elastic.middleRows<3>(at).cwiseAbs() + inertial.middleRows<3>(at).cwiseAbs();
    }
  }
  return rest.colwise().norm().cwiseQuotient(moduli.colwise().norm());
}

}  // namespace elastogear::fem
