#include "reduction/basis.h"

#include <Eigen/Geometry>
#include <cmath>

namespace elastogear::reduction {
namespace {

constexpr int kInertiaRows = 9 + 3 + 3;  // of S_1, C_l, C_r

Eigen::SparseMatrix<double> diagonal(const Eigen::VectorXd& d) {
  Eigen::SparseMatrix<double> D(d.size(), d.size());
  D = d.asDiagonal();
  return D;
}

void resize_coupling(model::Inertia& inertia, Eigen::Index n_q) {
  inertia.C_l.setZero(n_q, 3);
  inertia.C_r.setZero(n_q, 3);
  inertia.S_1.setZero(9, n_q);
}

Eigen::Index stress_rows(const model::ElasticBody& body) {
  return 6 * static_cast<Eigen::Index>(body.stress.node.size());
}

// 3 n_nodes x n_free selection: column j is the unit vector of free_dof[j].
Eigen::SparseMatrix<double> unit_columns(const std::vector<int>& free_dof, Eigen::Index n_dofs) {
  Eigen::SparseMatrix<double> I(n_dofs, static_cast<Eigen::Index>(free_dof.size()));
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t j = 0; j < free_dof.size(); ++j)
    entries.emplace_back(free_dof[j], static_cast<int>(j), 1.0);
  I.setFromTriplets(entries.begin(), entries.end());
  return I;
}

// 3 n_s x 3 n_nodes selection of the given nodes.
model::SparseRows node_rows(const std::vector<int>& nodes, Eigen::Index n_dofs) {
  model::SparseRows R(3 * static_cast<Eigen::Index>(nodes.size()), n_dofs);
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (int d = 0; d < 3; ++d) entries.emplace_back(static_cast<int>(3 * i) + d, 3 * nodes[i] + d, 1.0);
  R.setFromTriplets(entries.begin(), entries.end());
  return R;
}

}  // namespace

void allocate_modes(model::ElasticBody& body, int n_q) {
  body.basis = model::Basis::modal;
  resize_coupling(body.inertia, n_q);
  body.surface.Phi = model::DenseRows::Zero(3 * static_cast<Eigen::Index>(body.surface.node.size()), n_q);
  body.stress.Psi = model::DenseRows::Zero(stress_rows(body), n_q);
  for (model::Marker& marker : body.markers) marker.Phi = model::DenseRows::Zero(6, n_q);
}

void add_modes(model::ElasticBody& body, int n) {
  const auto widen = [&](auto& rows) { rows.conservativeResize(Eigen::NoChange, rows.cols() + n); };
  widen(std::get<model::DenseRows>(body.surface.Phi));
  widen(std::get<model::DenseRows>(body.stress.Psi));
  for (model::Marker& marker : body.markers) widen(std::get<model::DenseRows>(marker.Phi));
  model::Inertia& inertia = body.inertia;
  widen(inertia.S_1);
  for (auto* C : {&inertia.C_l, &inertia.C_r}) C->conservativeResize(C->rows() + n, Eigen::NoChange);
}

Eigen::VectorXd mode_column(const model::ElasticBody& body, const Eigen::VectorXd& phi,
                            const fem::MassMoments& moments, const model::SparseRows& S) {
  const auto n_s = 3 * static_cast<Eigen::Index>(body.surface.node.size()), n_e = S.rows();
  Eigen::VectorXd column(n_s + n_e + kInertiaRows);
  for (std::size_t i = 0; i < body.surface.node.size(); ++i)
    column.segment<3>(static_cast<Eigen::Index>(3 * i)) = phi.segment<3>(3 * body.surface.node[i]);
  column.segment(n_s, n_e) = S * phi;
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> S_1 = fem::first_moment(moments, phi);
  column.tail<kInertiaRows>() << S_1.reshaped<Eigen::RowMajor>(), fem::translational_coupling(moments, phi),
      fem::rotational_coupling(S_1);
  return column;
}

void set_mode(model::ElasticBody& body, int k, const Eigen::VectorXd& column) {
  auto& Phi = std::get<model::DenseRows>(body.surface.Phi);
  auto& Psi = std::get<model::DenseRows>(body.stress.Psi);
  Phi.col(k) = column.head(Phi.rows());
  Psi.col(k) = column.segment(Phi.rows(), Psi.rows());
  for (Eigen::Index row = Phi.rows() + Psi.rows(); model::Marker & marker : body.markers) {
    std::get<model::DenseRows>(marker.Phi).col(k) = column.segment<6>(row);
    row += 6;
  }
  const auto tail = column.tail<kInertiaRows>();
  body.inertia.S_1.col(k) = tail.head<9>();
  body.inertia.C_l.row(k) = tail.segment<3>(9);
  body.inertia.C_r.row(k) = tail.tail<3>();
}

void set_modal_matrices(model::ElasticBody& body, const Eigen::VectorXd& eigenvalue) {
  body.frequency = eigenvalue.cwiseSqrt() / (2 * M_PI);
  body.K_r = diagonal(eigenvalue);
  body.M_r = diagonal(Eigen::VectorXd::Ones(eigenvalue.size()));
}

void set_full_basis(model::ElasticBody& body, const std::vector<int>& free_dof,
                    const fem::MassMoments& moments, const model::SparseRows& S) {
  body.basis = model::Basis::full;
  const Eigen::Index n_dofs = 3 * moments.n_nodes();
  const auto Phi = unit_columns(free_dof, n_dofs);
  body.surface.Phi = model::SparseRows(node_rows(body.surface.node, n_dofs) * Phi);
  const model::SparseRows rows = S * Phi;
  Eigen::Index row = stress_rows(body);
  body.stress.Psi = model::SparseRows(rows.topRows(row));
  for (model::Marker& marker : body.markers) {
    marker.Phi = model::SparseRows(rows.middleRows(row, 6));
    row += 6;
  }
  resize_coupling(body.inertia, Phi.cols());
  for (Eigen::Index j = 0; j < Phi.cols(); ++j) {
    const int dof = free_dof[static_cast<std::size_t>(j)];
    const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> S_1 = fem::first_moment(moments, dof);
    body.inertia.C_l.row(j) = fem::translational_coupling(moments, dof);
    body.inertia.C_r.row(j) = fem::rotational_coupling(S_1);
    body.inertia.S_1.col(j) = S_1.reshaped<Eigen::RowMajor>();
  }
}

}  // namespace elastogear::reduction
