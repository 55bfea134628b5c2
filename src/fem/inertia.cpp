#include "elastogear/fem/inertia.h"

#include "elastogear/fem/element.h"

namespace elastogear::fem {
namespace {

Eigen::Map<const Eigen::Matrix3Xd> by_node(const Eigen::VectorXd& phi) {
  return {phi.data(), 3, phi.size() / 3};
}

}  // namespace

model::SparseRows scalar_mass(const mesh::Mesh& mesh, const std::vector<model::MaterialRegion>& regions) {
  const std::vector<int> region = cell_regions(mesh, regions);
  std::vector<Eigen::Triplet<double>> entries;
  for (int cell = 0; cell < mesh.cells.size(); ++cell) {
    const auto nodes = mesh.cells[cell];
    const auto& functions = element_functions(mesh.cells.type[cell]);
    const Eigen::MatrixXd M_e =
        functions.mass(cell_coordinates(mesh, cell), regions[region[cell]].material.rho);
    for (int a = 0; a < M_e.rows(); ++a)
      for (int b = 0; b < M_e.cols(); ++b) entries.emplace_back(nodes[a], nodes[b], M_e(a, b));
  }
  model::SparseRows M_s(mesh.n_nodes(), mesh.n_nodes());
  M_s.setFromTriplets(entries.begin(), entries.end());
  return M_s;
}

MassMoments mass_moments(const mesh::Mesh& mesh, const std::vector<model::MaterialRegion>& regions) {
  const std::vector<int> region = cell_regions(mesh, regions);
  MassMoments moments{Eigen::VectorXd::Zero(mesh.n_nodes()), Eigen::Matrix3Xd::Zero(3, mesh.n_nodes())};
  for (int cell = 0; cell < mesh.cells.size(); ++cell) {
    const Eigen::Matrix3Xd X = cell_coordinates(mesh, cell);
    const auto& functions = element_functions(mesh.cells.type[cell]);
    const Eigen::MatrixXd M_e = functions.mass(X, regions[region[cell]].material.rho);
    const Eigen::VectorXd sums = M_e.rowwise().sum();
    const Eigen::Matrix3Xd first = X * M_e;
    const auto nodes = mesh.cells[cell];
    for (int a = 0; a < static_cast<int>(nodes.size()); ++a) {
      moments.w_0(nodes[a]) += sums(a);
      moments.w_1.col(nodes[a]) += first.col(a);
    }
  }
  return moments;
}

model::Inertia rigid_inertia(const mesh::Mesh& mesh, const MassMoments& moments) {
  model::Inertia inertia;
  inertia.m = moments.w_0.sum();
  inertia.c = moments.w_1.rowwise().sum() / inertia.m;
  const Eigen::Matrix3d P = moments.w_1 * mesh.X.transpose();  // integral of rho X X' dV
  inertia.J = P.trace() * Eigen::Matrix3d::Identity() - (P + P.transpose()) / 2;
  return inertia;
}

Eigen::Matrix3d first_moment(const MassMoments& moments, const Eigen::VectorXd& phi) {
  return moments.w_1 * by_node(phi).transpose();
}

Eigen::Vector3d translational_coupling(const MassMoments& moments, const Eigen::VectorXd& phi) {
  return by_node(phi) * moments.w_0;
}

Eigen::Vector3d rotational_coupling(const Eigen::Matrix3d& S) {
  return {S(1, 2) - S(2, 1), S(2, 0) - S(0, 2), S(0, 1) - S(1, 0)};
}

}  // namespace elastogear::fem
