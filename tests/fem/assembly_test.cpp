#include "elastogear/fem/assembly.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "system.h"

namespace elastogear::assembly_test {
namespace {

constexpr double kRoundoff = 1e-12;

bool is_root() {
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  return rank == 0;
}

mesh::Mesh small_body() { return test::distorted(test::brick({4, 3, 3}, {2, 1, 1}), 0.1); }

// Straightforward dense assembly over all nodes.
Eigen::MatrixXd dense(const mesh::Mesh& mesh, bool stiffness) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(3 * mesh.n_nodes(), 3 * mesh.n_nodes());
  for (int cell = 0; cell < mesh.cells.size(); ++cell) {
    const auto X = fem::cell_coordinates(mesh, cell);
    const auto& functions = fem::element_functions(mesh.cells.type[cell]);
    const Eigen::MatrixXd M_e = functions.mass(X, test::kSteel.rho);
    const Eigen::MatrixXd K_e = functions.stiffness(X, fem::lame(test::kSteel), model::Element::incompatible);
    for (int a = 0; a < 8; ++a)
      for (int b = 0; b < 8; ++b) {
        auto block = A.block<3, 3>(3 * mesh.cells[cell][a], 3 * mesh.cells[cell][b]);
        if (stiffness)
          block += K_e.block<3, 3>(3 * a, 3 * b);
        else
          block.diagonal().array() += M_e(a, b);
      }
  }
  return A;
}

TEST(Assembly, equals_dense_assembly_without_the_restrained_rows) {
  const auto mesh = small_body();
  const auto system = test::assemble(mesh, {"xmin"});
  const auto dofs = fem::free_dofs(fem::held_directions(mesh, {"xmin"}));
  for (bool stiffness : {true, false}) {
    const Mat A = stiffness ? system.matrices.K : system.matrices.M;
    const Eigen::MatrixXd gathered = fem::gather_matrix(A, system.rows);
    if (!is_root()) continue;
    const Eigen::MatrixXd expected = dense(mesh, stiffness)(dofs, dofs);
    ASSERT_EQ(gathered.rows(), expected.rows());
    EXPECT_LT((gathered - expected).norm(), kRoundoff * expected.norm());
  }
}

TEST(Assembly, of_a_free_body_annihilates_the_six_rigid_modes) {
  const auto mesh = small_body();
  const auto system = test::assemble(mesh, {});
  const Eigen::MatrixXd K = fem::gather_matrix(system.matrices.K, system.rows);
  if (!is_root()) return;
  for (int i = 0; i < 3; ++i) {
    Eigen::Matrix3Xd shift = Eigen::Matrix3Xd::Zero(3, mesh.n_nodes()), turn = shift;
    shift.row(i).setOnes();
    for (int n = 0; n < mesh.n_nodes(); ++n) turn.col(n) = Eigen::Vector3d::Unit(i).cross(mesh.X.col(n));
    EXPECT_LT((K * shift.reshaped()).norm(), kRoundoff * K.norm());
    EXPECT_LT((K * turn.reshaped()).norm(), kRoundoff * K.norm());
  }
}

TEST(Assembly, allocates_exactly_what_it_fills) {
  const auto system = test::assemble(small_body(), {"xmin"});
  for (const Mat A : {system.matrices.K.get(), system.matrices.M.get()}) {
    MatInfo info;
    ASSERT_EQ(MatGetInfo(A, MAT_GLOBAL_SUM, &info), 0);
    EXPECT_EQ(info.nz_unneeded, 0);
    EXPECT_EQ(info.mallocs, 0);
  }
}

TEST(VectorGather, returns_the_mesh_order_with_zeros_where_restrained) {
  const auto mesh = small_body();
  const auto system = test::assemble(mesh, {"xmin"});
  UniqueVec v;
  check(MatCreateVecs(system.matrices.K, v.out(), nullptr));
  PetscInt begin = 0, end = 0;
  check(VecGetOwnershipRange(v, &begin, &end));
  for (PetscInt i = begin; i < end; ++i)
    check(VecSetValue(v, i, 3 * system.rows.node[i / 3] + i % 3 + 1, INSERT_VALUES));
  check(VecAssemblyBegin(v));
  check(VecAssemblyEnd(v));
  const fem::VectorGather gather(v, system.rows);
  const Eigen::VectorXd u = gather(v);
  const auto is_free = fem::free_nodes(mesh, {"xmin"});
  for (int i = 0; is_root() && i < u.size(); ++i) EXPECT_EQ(u(i), is_free[i / 3] ? i + 1 : 0);
}

}  // namespace
}  // namespace elastogear::assembly_test
