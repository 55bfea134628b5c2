#include "elastogear/fem/element.h"

#include "elastogear/base/error.h"
#include "fem/elements/hex8.h"
#include "fem/elements/isoparametric.h"

namespace elastogear::fem {
namespace {

constexpr ElementFunctions kHex8 = {
    8,
    [](const Eigen::Matrix3Xd& X) { return hex8::smallest_jacobian(X); },
    [](const Eigen::Matrix3Xd& X) { return hex8::volume(X); },
    [](const Eigen::Matrix3Xd& X, const Elasticity& material, model::Element element) -> Eigen::MatrixXd {
      return hex8::stiffness(X, material, element);
    },
    [](const Eigen::Matrix3Xd& X, const Elasticity& material, const Elasticity& part, model::Element element)
        -> Eigen::MatrixXd { return hex8::stiffness_of_part(X, material, part, element); },
    [](const Eigen::Matrix3Xd& X, double rho) -> Eigen::MatrixXd { return hex8::mass(X, rho); },
    [](const Eigen::Matrix3Xd& X, const Elasticity& material, model::Element element) -> Eigen::MatrixXd {
      return hex8::stress(X, material, element);
    }};

}  // namespace

const ElementFunctions& element_functions(mesh::CellType type) {
  using mesh::CellType;
  switch (type) {
    case CellType::hex8:
      return kHex8;
    case CellType::hex20:
      return kIsoparametric<CellType::hex20, 20, 27>;
    case CellType::tet4:
      return kIsoparametric<CellType::tet4, 4, 1>;
    case CellType::tet10:
      return kIsoparametric<CellType::tet10, 10, 4>;
    case CellType::wedge6:
      return kIsoparametric<CellType::wedge6, 6, 2>;
    case CellType::wedge15:
      return kIsoparametric<CellType::wedge15, 15, 9>;
    case CellType::pyramid5:
      return kIsoparametric<CellType::pyramid5, 5, 8>;
  }
  fail("no element for cell type ", static_cast<int>(type));
}

CellModuli::CellModuli(const model::Material& material) : elastic(elasticity(material)) {
  if (!material.relaxed.empty()) relaxed = relaxed_elasticity(material);
}

Eigen::MatrixXd cell_stiffness(const ElementFunctions& functions, const Eigen::Matrix3Xd& X,
                               const CellModuli& moduli, model::Element element) {
  return moduli.relaxed ? functions.stiffness_of_part(X, moduli.elastic, *moduli.relaxed, element)
                        : functions.stiffness(X, moduli.elastic, element);
}

Eigen::Matrix3Xd cell_coordinates(const mesh::Mesh& mesh, int cell) {
  const auto nodes = mesh.cells[cell];
  Eigen::Matrix3Xd X(3, nodes.size());
  for (std::size_t a = 0; a < nodes.size(); ++a) X.col(static_cast<Eigen::Index>(a)) = mesh.X.col(nodes[a]);
  return X;
}

void require_positive_jacobians(const mesh::Mesh& mesh) {
  for (int cell = 0; cell < mesh.cells.size(); ++cell) {
    const double det =
        element_functions(mesh.cells.type[cell]).smallest_jacobian(cell_coordinates(mesh, cell));
    if (det > 0) continue;
    std::string nodes;
    for (int node : mesh.cells[cell]) nodes += (nodes.empty() ? "" : ", ") + mesh::node_text(mesh, node);
    fail(mesh::cell_text(mesh, cell), ", of ", nodes, ", has the Jacobian ", det,
         " m^3, must be positive: it is inverted or too distorted");
  }
}

}  // namespace elastogear::fem
