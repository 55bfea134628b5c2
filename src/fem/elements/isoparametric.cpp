#include "fem/elements/isoparametric.h"

#include <Eigen/QR>
#include <map>

#include "elastogear/base/error.h"
#include "fem/elements/quadrature.h"
#include "fem/elements/shape.h"

namespace elastogear::fem {
namespace {

using mesh::CellType;

struct Rules {
  Rule stiffness, mass, stress;
};

// Quadrature rules of a cell type. Stiffness: the rules of Abaqus and CalculiX, the smallest that pass the
// patch test on straight-edged cells. They leave no zero-energy mode but one: wedge6's two points do not see
// its twist about the line through them, which other cells beside it resist. Mass: exact on straight-edged
// cells. Stress: the points at which it is most accurate.
Rules rules(CellType type) {
  switch (type) {
    case CellType::hex20:
      return {hexahedron_rule(3), hexahedron_rule(3), hexahedron_rule(2)};
    case CellType::tet4:
      return {tetrahedron_rule(1), tetrahedron_rule(4), tetrahedron_rule(1)};
    case CellType::tet10:
      return {tetrahedron_rule(4), tetrahedron_rule(15), tetrahedron_rule(4)};
    case CellType::wedge6:
      return {wedge_rule(1, 2), wedge_rule(6, 3), wedge_rule(1, 2)};
    case CellType::wedge15:
      return {wedge_rule(3, 3), wedge_rule(6, 3), wedge_rule(3, 2)};
    case CellType::pyramid5:
      return {hexahedron_rule(2), hexahedron_rule(3), hexahedron_rule(2)};
    case CellType::hex8:
      break;
  }
  fail("no plain isoparametric element for ", mesh::name(type));
}

// The polynomials that nodal stress is fitted with.
Eigen::VectorXd stress_polynomials(CellType type, const Eigen::Vector3d& xi) {
  const double x = xi.x(), y = xi.y(), z = xi.z();
  switch (type) {
    case CellType::tet4:
      return Eigen::VectorXd::Ones(1);
    case CellType::tet10:
      return Eigen::Vector4d(1, x, y, z);
    case CellType::wedge6:
      return Eigen::Vector2d(1, z);
    case CellType::wedge15:
      return Eigen::Vector<double, 6>{1, x, y, z, x * z, y * z};
    case CellType::pyramid5:  // linear in the pyramid, whose cross-section shrinks with 1 - z
      return Eigen::Vector4d(1, x * (1 - z), y * (1 - z), z);
    default:
      return Eigen::Vector<double, 8>{1, x, y, z, x * y, y * z, z * x, x * y * z};
  }
}

// Rows: the polynomials at each point.
Eigen::MatrixXd polynomials_at(CellType type, const Eigen::Matrix3Xd& points) {
  Eigen::MatrixXd P(points.cols(), stress_polynomials(type, Eigen::Vector3d::Zero()).size());
  for (Eigen::Index p = 0; p < points.cols(); ++p)
    P.row(p) = stress_polynomials(type, Eigen::Vector3d(points.col(p))).transpose();
  return P;
}

Samples sample(CellType type, const Rule& rule) {
  Samples samples{rule.w, Eigen::MatrixXd(mesh::node_count(type), rule.w.size()), {}};
  for (Eigen::Index p = 0; p < rule.w.size(); ++p) {
    const ShapeValues values = shape_values(type, rule.xi.col(p));
    samples.N.col(p) = values.N;
    samples.dN.push_back(values.dN);
  }
  return samples;
}

ReferenceCell tabulate(CellType type) {
  const Rules r = rules(type);
  const Eigen::MatrixXd at_points = polynomials_at(type, r.stress.xi);
  const Eigen::MatrixXd fit =
      at_points.colPivHouseholderQr().solve(Eigen::MatrixXd::Identity(at_points.rows(), at_points.rows()));
  return {sample(type, r.stiffness), sample(type, r.mass), sample(type, r.stress),
          polynomials_at(type, reference_nodes(type)) * fit};
}

double jacobian(const Eigen::Matrix3Xd& X, const Eigen::MatrixXd& dN) {
  return Eigen::Matrix3d(X * dN).determinant();
}

// w det J at the points of the mass rule: integrals over the cell.
Eigen::VectorXd volumes(const ReferenceCell& cell, const Eigen::Matrix3Xd& X) {
  Eigen::VectorXd dV = cell.mass.w;
  for (int p = 0; p < cell.mass.size(); ++p) dV(p) *= jacobian(X, cell.mass.dN[p]);
  return dV;
}

}  // namespace

const ReferenceCell& reference_cell(CellType type) {
  static const std::map<CellType, ReferenceCell> cells = [] {
    std::map<CellType, ReferenceCell> table;
    for (int i = 0; i < mesh::kCellTypes; ++i)
      if (const auto t = static_cast<CellType>(i); t != CellType::hex8) table.emplace(t, tabulate(t));
    return table;
  }();
  const auto found = cells.find(type);
  require(found != cells.end(), "no plain isoparametric element for ", mesh::name(type));
  return found->second;
}

double smallest_jacobian(const ReferenceCell& cell, const Eigen::Matrix3Xd& X) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const Samples* samples : {&cell.stiffness, &cell.mass, &cell.stress})
    for (const Eigen::MatrixXd& dN : samples->dN)
      if (const double det = jacobian(X, dN); !(det >= smallest)) smallest = det;
  return smallest;
}

double volume(const ReferenceCell& cell, const Eigen::Matrix3Xd& X) { return volumes(cell, X).sum(); }

Eigen::MatrixXd mass(const ReferenceCell& cell, const Eigen::Matrix3Xd& X, double rho) {
  return rho * (cell.mass.N * volumes(cell, X).asDiagonal() * cell.mass.N.transpose());
}

}  // namespace elastogear::fem
