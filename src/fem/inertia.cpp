#include "elastogear/fem/inertia.h"

#include <span>

#include "elastogear/base/rotation.h"
#include "elastogear/fem/element.h"
#include "fem/elements/cell_mass.h"

namespace elastogear::fem {
namespace {

Eigen::Map<const Eigen::Matrix3Xd> by_node(const Eigen::VectorXd& phi) {
  return {phi.data(), 3, phi.size() / 3};
}

// Calls visit(cell, its mass) for every cell.
template <class Visit>
void visit_cells(const mesh::Mesh& mesh, const std::vector<model::MaterialRegion>& regions,
                 const model::Formulation& formulation, const Visit& visit) {
  const std::vector<int> region = cell_regions(mesh, regions);
  std::vector<Elasticity> elasticities;
  for (const auto& r : regions) elasticities.push_back(elasticity(r.material));
  for (int cell = 0; cell < mesh.cells.size(); ++cell)
    visit(cell, cell_mass(mesh.cells.type[cell], cell_coordinates(mesh, cell),
                          regions[region[cell]].material.rho, elasticities[region[cell]], formulation));
}

// Adds what the incompatible modes of a cell have of the moments.
void add_modes(MassMoments& moments, std::span<const int> nodes, const Eigen::Matrix3Xd& X,
               const CellMass& mass) {
  if (moments.modes.cols() == 0) moments.modes.setZero(12, 3 * moments.n_nodes());
  const Eigen::Index n = mass.n_nodes(), n_modes = mass.n_modes();
  Eigen::MatrixXd W(4, n);  // the constant and the linear fields at the nodes
  W << Eigen::RowVectorXd::Ones(n), X;
  const Eigen::MatrixXd W_P = W * mass.scalar.topRightCorner(n, n_modes);
  for (int b = 0; b < 3; ++b) {
    const Eigen::MatrixXd T_b = mass.T(Eigen::seqN(b, n_modes, 3), Eigen::all), moment = W_P * T_b;
    for (int f = 0; f < 4; ++f)
      for (std::size_t a = 0; a < nodes.size(); ++a)
        moments.modes.row(3 * f + b).segment<3>(3 * nodes[a]) +=
            moment.row(f).segment<3>(static_cast<Eigen::Index>(3 * a));
  }
}

}  // namespace

FieldMass field_mass(const mesh::Mesh& mesh, const std::vector<model::MaterialRegion>& regions,
                     const model::Formulation& formulation) {
  std::vector<Eigen::Triplet<double>> mass, amplitudes;
  int n = mesh.n_nodes();
  visit_cells(mesh, regions, formulation, [&](int cell, const CellMass& M_e) {
    std::vector<int> field(mesh.cells[cell].begin(), mesh.cells[cell].end());
    for (Eigen::Index r = 0; r < M_e.T.rows(); ++r)
      for (Eigen::Index c = 0; c < M_e.T.cols(); ++c)
        amplitudes.emplace_back(3 * (n - mesh.n_nodes()) + static_cast<int>(r),
                                3 * field[static_cast<std::size_t>(c / 3)] + static_cast<int>(c % 3),
                                M_e.T(r, c));
    for (Eigen::Index k = 0; k < M_e.n_modes(); ++k) field.push_back(n++);
    for (int a = 0; a < M_e.scalar.rows(); ++a)
      for (int b = 0; b < M_e.scalar.cols(); ++b) mass.emplace_back(field[a], field[b], M_e.scalar(a, b));
  });
  FieldMass result;
  result.M_s.resize(n, n);
  result.M_s.setFromTriplets(mass.begin(), mass.end());
  if (amplitudes.empty()) return result;
  result.T.resize(3 * (n - mesh.n_nodes()), 3 * mesh.n_nodes());
  result.T.setFromTriplets(amplitudes.begin(), amplitudes.end());
  return result;
}

MassMoments mass_moments(const mesh::Mesh& mesh, const std::vector<model::MaterialRegion>& regions,
                         const model::Formulation& formulation) {
  MassMoments moments{Eigen::VectorXd::Zero(mesh.n_nodes()), Eigen::Matrix3Xd::Zero(3, mesh.n_nodes())};
  visit_cells(mesh, regions, formulation, [&](int cell, const CellMass& mass) {
    const Eigen::Matrix3Xd X = cell_coordinates(mesh, cell);
    const Eigen::MatrixXd M_e = mass.scalar.topLeftCorner(mass.n_nodes(), mass.n_nodes());
    const Eigen::VectorXd sums = M_e.rowwise().sum();
    const Eigen::Matrix3Xd first = X * M_e;
    const auto nodes = mesh.cells[cell];
    for (int a = 0; a < static_cast<int>(nodes.size()); ++a) {
      moments.w_0(nodes[a]) += sums(a);
      moments.w_1.col(nodes[a]) += first.col(a);
    }
    if (mass.has_modes()) add_modes(moments, nodes, X, mass);
  });
  return moments;
}

void move_origin(MassMoments& moments, const Eigen::Vector3d& origin) {
  moments.w_1 -= origin * moments.w_0.transpose();
  if (moments.modes.cols() == 0) return;
  for (int a = 0; a < 3; ++a)
    moments.modes.middleRows<3>(3 + 3 * a) -= origin(a) * moments.modes.topRows<3>();
}

model::Inertia rigid_inertia(const mesh::Mesh& mesh, const MassMoments& moments) {
  model::Inertia inertia;
  inertia.m = moments.w_0.sum();
  inertia.c = moments.w_1.rowwise().sum() / inertia.m;
  const Eigen::Matrix3d P = moments.w_1 * mesh.X.transpose();  // integral of rho X X' dV
  inertia.J = P.trace() * Eigen::Matrix3d::Identity() - (P + P.transpose()) / 2;
  return inertia;
}

Eigen::VectorXd momentum(const MassMoments& moments, const Eigen::Vector3d& t, const Eigen::Vector3d& w) {
  const Eigen::Matrix3d w_cross = skew(w);
  Eigen::VectorXd p = (t * moments.w_0.transpose() + w_cross * moments.w_1).reshaped();
  if (moments.modes.cols() == 0) return p;
  p += moments.modes.topRows<3>().transpose() * t;
  for (int a = 0; a < 3; ++a) p += moments.modes.middleRows<3>(3 + 3 * a).transpose() * w_cross.col(a);
  return p;
}

Eigen::Matrix3d first_moment(const MassMoments& moments, const Eigen::VectorXd& phi) {
  Eigen::Matrix3d S = moments.w_1 * by_node(phi).transpose();
  if (moments.modes.cols() > 0) {
    const Eigen::Vector<double, 9> of_modes = moments.modes.bottomRows<9>() * phi;
    S += of_modes.reshaped<Eigen::RowMajor>(3, 3);
  }
  return S;
}

Eigen::Vector3d translational_coupling(const MassMoments& moments, const Eigen::VectorXd& phi) {
  Eigen::Vector3d p = by_node(phi) * moments.w_0;
  if (moments.modes.cols() > 0) p += moments.modes.topRows<3>() * phi;
  return p;
}

Eigen::Matrix3d first_moment(const MassMoments& moments, int dof) {
  Eigen::Matrix3d S = moments.w_1.col(dof / 3) * Eigen::RowVector3d::Unit(dof % 3);
  if (moments.modes.cols() > 0) S += moments.modes.col(dof).tail<9>().reshaped<Eigen::RowMajor>(3, 3);
  return S;
}

Eigen::Vector3d translational_coupling(const MassMoments& moments, int dof) {
  Eigen::Vector3d p = moments.w_0(dof / 3) * Eigen::Vector3d::Unit(dof % 3);
  if (moments.modes.cols() > 0) p += moments.modes.col(dof).head<3>();
  return p;
}

Eigen::Vector3d rotational_coupling(const Eigen::Matrix3d& S) {
  return {S(1, 2) - S(2, 1), S(2, 0) - S(0, 2), S(0, 1) - S(1, 0)};
}

}  // namespace elastogear::fem
