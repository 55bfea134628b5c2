#include "reduction/basis.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "../fem/brick.h"
#include "elastogear/fem/element.h"
#include "elastogear/fem/restraint.h"
#include "elastogear/fem/stress.h"

namespace elastogear::basis_test {
namespace {

constexpr double kRoundoff = 1e-12;

struct Example {
  mesh::Mesh mesh = test::distorted(test::brick({3, 2, 2}, {2, 1, 0.5}), 0.03);
  fem::MassMoments moments = fem::mass_moments(mesh, test::kSteelBody);
  model::SparseRows S;
  model::ElasticBody body;

  Example() {
    body.surface.node = mesh.node_sets["zmax"];
    body.stress.node = mesh.node_sets["xmax"];
    S = fem::stress_operator({mesh, test::kSteelBody, model::Element::incompatible}, body.stress.node);
  }
};

// M_f of all nodes, and the fields S_t (constant) and S_r (unit rotations) at all nodes.
Eigen::MatrixXd dense_mass(const mesh::Mesh& mesh) {
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(3 * mesh.n_nodes(), 3 * mesh.n_nodes());
  for (int cell = 0; cell < mesh.cells.size(); ++cell) {
    const Eigen::MatrixXd M_e = fem::element_functions(mesh::CellType::hex8)
                                    .mass(fem::cell_coordinates(mesh, cell), test::kSteel.rho);
    for (int a = 0; a < 8; ++a)
      for (int b = 0; b < 8; ++b)
        M.block<3, 3>(3 * mesh.cells[cell][a], 3 * mesh.cells[cell][b]).diagonal().array() += M_e(a, b);
  }
  return M;
}

Eigen::MatrixXd rigid_fields(const mesh::Mesh& mesh, bool rotations) {
  Eigen::MatrixXd fields(3 * mesh.n_nodes(), 3);
  for (int i = 0; i < mesh.n_nodes(); ++i)
    for (int a = 0; a < 3; ++a) {
      const Eigen::Vector3d e = Eigen::Vector3d::Unit(a), X = mesh.X.col(i);
      fields.block<3, 1>(3 * i, a) = rotations ? Eigen::Vector3d(e.cross(X)) : e;
    }
  return fields;
}

TEST(Inertia, equals_the_products_of_the_consistent_mass_with_rigid_fields) {
  const Example example;
  const auto inertia = fem::rigid_inertia(example.mesh, example.moments);
  const Eigen::MatrixXd M = dense_mass(example.mesh);
  const Eigen::MatrixXd S_t = rigid_fields(example.mesh, false), S_r = rigid_fields(example.mesh, true);
  const Eigen::Matrix3d m_I = inertia.m * Eigen::Matrix3d::Identity();
  EXPECT_LT((S_t.transpose() * M * S_t - m_I).norm(), kRoundoff * inertia.m);
  EXPECT_LT((S_r.transpose() * M * S_r - inertia.J).norm(), kRoundoff * inertia.J.norm());
}

TEST(ModalBasis, couples_like_the_dense_matrices) {
  Example example;
  const Eigen::MatrixXd M = dense_mass(example.mesh);
  const Eigen::MatrixXd Phi = Eigen::MatrixXd::Random(M.rows(), 2);
  reduction::allocate_modes(example.body, 2);
  for (int k = 0; k < 2; ++k)
    reduction::set_mode(example.body, k,
                        reduction::mode_column(example.body, Phi.col(k), example.moments, example.S));
  const auto& inertia = example.body.inertia;
  const Eigen::MatrixXd C_l = Phi.transpose() * M * rigid_fields(example.mesh, false);
  const Eigen::MatrixXd C_r = Phi.transpose() * M * rigid_fields(example.mesh, true);
  EXPECT_LT((inertia.C_l - C_l).norm(), kRoundoff * C_l.norm());
  EXPECT_LT((inertia.C_r - C_r).norm(), kRoundoff * C_r.norm());
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) {
      Eigen::VectorXd X_a = Eigen::VectorXd::Zero(M.rows());  // the field X_a e_b
      for (int i = 0; i < example.mesh.n_nodes(); ++i) X_a(3 * i + b) = example.mesh.X(a, i);
      const Eigen::VectorXd S_1 = Phi.transpose() * M * X_a;
      EXPECT_LT((inertia.S_1.row(3 * a + b).transpose() - S_1).norm(), kRoundoff * C_l.norm());
    }
}

TEST(ModalBasis, has_the_rows_of_its_nodes) {
  Example example;
  const Eigen::VectorXd phi = Eigen::VectorXd::Random(3 * example.mesh.n_nodes());
  reduction::allocate_modes(example.body, 1);
  reduction::set_mode(example.body, 0, reduction::mode_column(example.body, phi, example.moments, example.S));
  const Eigen::VectorXd q = Eigen::VectorXd::Ones(1);
  const auto& nodes = example.body.surface.node;
  for (int i = 0; i < static_cast<int>(nodes.size()); ++i)
    EXPECT_EQ(model::displacement(example.body.surface.Phi, i, q), phi.segment<3>(3 * nodes[i]));
  EXPECT_EQ(model::multiply(example.body.stress.Psi, q), example.S * phi);
}

TEST(FullBasis, is_the_modal_one_of_unit_vectors) {
  Example full, modal;
  const auto free_dof = fem::free_dofs(fem::held_directions(full.mesh, {"xmin"}));
  const int n = static_cast<int>(free_dof.size());
  reduction::set_full_basis(full.body, free_dof, full.moments, full.S);
  reduction::allocate_modes(modal.body, n);
  for (int k = 0; k < n; ++k)
    reduction::set_mode(
        modal.body, k,
        reduction::mode_column(modal.body, Eigen::VectorXd::Unit(3 * full.mesh.n_nodes(), free_dof[k]),
                               full.moments, full.S));
  const auto &a = full.body, &b = modal.body;
  EXPECT_LT((a.inertia.C_l - b.inertia.C_l).norm(), kRoundoff * b.inertia.C_l.norm());
  EXPECT_LT((a.inertia.C_r - b.inertia.C_r).norm(), kRoundoff * b.inertia.C_r.norm());
  EXPECT_LT((a.inertia.S_1 - b.inertia.S_1).norm(), kRoundoff * b.inertia.S_1.norm());
  const Eigen::VectorXd q = Eigen::VectorXd::Random(n);
  EXPECT_EQ(model::multiply(a.surface.Phi, q), model::multiply(b.surface.Phi, q));
  const Eigen::VectorXd difference = model::multiply(a.stress.Psi, q) - model::multiply(b.stress.Psi, q);
  EXPECT_LT(difference.norm(), kRoundoff * model::multiply(b.stress.Psi, q).norm());
}

}  // namespace
}  // namespace elastogear::basis_test
