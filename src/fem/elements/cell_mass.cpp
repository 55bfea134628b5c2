#include "fem/elements/cell_mass.h"

#include "fem/elements/hex8.h"

namespace elastogear::fem {
namespace {

using Eigen::Index;

// M (x) I_3.
Eigen::MatrixXd in_three_directions(const Eigen::MatrixXd& M) {
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(3 * M.rows(), 3 * M.cols());
  for (Index b = 0; b < M.cols(); ++b)
    for (Index a = 0; a < M.rows(); ++a) all.block<3, 3>(3 * a, 3 * b).diagonal().setConstant(M(a, b));
  return all;
}

}  // namespace

CellMass cell_mass(mesh::CellType type, const Eigen::Matrix3Xd& X, double rho, const Elasticity& elasticity,
                   const model::Formulation& formulation) {
  const bool condensed = type == mesh::CellType::hex8 &&
                         formulation.element == model::Element::incompatible &&
                         formulation.mass == model::ElementMass::condensed;
  if (!condensed) return {element_functions(type).mass(X, rho), {}};
  return {hex8::mass_with_modes(X, rho), hex8::incompatible_amplitudes(X, elasticity)};
}

Eigen::MatrixXd mass_matrix(const CellMass& mass) {
  const Index n = mass.n_nodes(), n_modes = mass.n_modes();
  Eigen::MatrixXd M = in_three_directions(mass.scalar.topLeftCorner(n, n));
  if (!mass.has_modes()) return M;
  const Eigen::MatrixXd M_uT = in_three_directions(mass.scalar.topRightCorner(n, n_modes)) * mass.T;
  M += M_uT + M_uT.transpose();
  M += mass.T.transpose() * in_three_directions(mass.scalar.bottomRightCorner(n_modes, n_modes)) * mass.T;
  return (M + M.transpose()) / 2;
}

}  // namespace elastogear::fem
