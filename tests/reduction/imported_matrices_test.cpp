// Matrices of other programs, read from files.
#include "elastogear/reduction/imported.h"

#include <gtest/gtest.h>

#include "elastogear/base/error.h"
#include "imported_files.h"

namespace elastogear::imported_matrices_test {
namespace {

using namespace test;

void expect_equal(const reduction::ImportedSystem& read, const Files& files) {
  const Eigen::MatrixXd K = fem::gather_matrix(read.matrices.K, read.dof);
  const Eigen::MatrixXd M = fem::gather_matrix(read.matrices.M, read.dof);
  if (!is_root()) return;
  EXPECT_EQ(read.dof, files.K.dof);
  EXPECT_LT((K - Eigen::MatrixXd(files.K.A)).norm(), 1e-15 * K.norm());
  EXPECT_LT((M - Eigen::MatrixXd(files.M.A)).norm(), 1e-15 * M.norm());
}

TEST(ImportedMatrices, are_the_same_from_each_half_and_from_the_whole) {
  const auto mesh = block();
  Files files = our_matrices(mesh, {});
  for (Half half : {Half::lower, Half::upper, Half::both}) {
    if (is_root()) {
      write_triplets(files.imported.stiffness, files.K, half);
      write_triplets(files.imported.mass, files.M, half);
    }
    expect_equal(read(mesh, files.imported), files);
  }
  if (is_root()) write_matrix_market(files.imported.stiffness, files.K);
  expect_equal(read(mesh, files.imported), files);
}

TEST(ImportedMatrices, of_abaqus_are_read_by_node_numbers_in_its_units) {
  const auto mesh = block();
  Files files = our_matrices(mesh, {});
  for (int i = 1; i <= mesh.n_nodes(); ++i) files.imported.node_number.push_back(10 * i);
  files.imported.stiffness_unit = files.imported.mass_unit = 1000;  // N/mm, t
  if (is_root()) {
    write_abaqus(files.imported.stiffness, files.K, 1000);
    write_abaqus(files.imported.mass, files.M, 1000);
  }
  expect_equal(read(mesh, files.imported), files);
}

TEST(ImportedMatrices, leave_out_displacements_that_abaqus_holds) {
  const auto mesh = block();
  Files free = our_matrices(mesh, {"xmin"}), all = our_matrices(mesh, {});
  for (int node : mesh.node_sets.at("xmin"))
    for (int d = 0; d < 3; ++d) all.K.A.coeffRef(3 * node + d, 3 * node + d) = 1e36;
  for (int i = 1; i <= mesh.n_nodes(); ++i) all.imported.node_number.push_back(10 * i);
  if (is_root()) {
    write_abaqus(all.imported.stiffness, all.K, 1);
    write_abaqus(all.imported.mass, all.M, 1);
  }
  expect_equal(read(mesh, all.imported), free);
}

TEST(ImportedMass, has_the_moments_of_the_elements) {
  const auto mesh = block();
  Files files = our_matrices(mesh, {});
  if (is_root()) {
    write_triplets(files.imported.stiffness, files.K, Half::lower);
    write_triplets(files.imported.mass, files.M, Half::lower);
  }
  const auto system = read(mesh, files.imported);
  UniqueVec layout;
  check(MatCreateVecs(system.matrices.M, layout.out(), nullptr));
  const fem::VectorGather gather(layout, system.dof, 3 * mesh.n_nodes());
  const auto moments = reduction::mass_moments(system.matrices.M, gather, is_root() ? mesh : mesh::Mesh{});
  const auto expected = fem::mass_moments(mesh, test::kSteelBody);
  if (!is_root()) return;
  EXPECT_TRUE(reduction::is_complete(mesh, system.dof));
  EXPECT_LT((moments.w_0 - expected.w_0).norm(), 1e-13 * expected.w_0.norm());
  EXPECT_LT((moments.w_1 - expected.w_1).norm(), 1e-13 * expected.w_1.norm());
}

TEST(ImportedMass, that_depends_on_the_direction_has_no_scalar_part) {
  const auto mesh = block();
  for (const auto& [row, column] : {std::pair(3, 3), std::pair(3, 4)}) {
    Files files = our_matrices(mesh, {});
    files.M.A.coeffRef(row, column) += 0.1 * files.M.A.coeff(row, row);
    if (row != column) files.M.A.coeffRef(column, row) = files.M.A.coeff(row, column);
    if (is_root()) {
      write_triplets(files.imported.stiffness, files.K, Half::lower);
      write_triplets(files.imported.mass, files.M, Half::lower);
    }
    const auto system = read(mesh, files.imported);
    EXPECT_THROW(reduction::scalar_mass(system, is_root() ? mesh.n_nodes() : 0), Error);
  }
}

// Without the x of some nodes and the y of others no entry tells what mass these share.
TEST(ImportedMass, of_nodes_without_a_common_direction_is_refused) {
  const auto mesh = block();
  Files files = our_matrices(mesh, {});
  const auto keep = [](int dof) { return dof / 3 > 1 || dof % 3 == dof / 3; };  // 0.x, 1.y, all others
  std::vector<int> kept;
  for (int dof = 0; dof < 3 * mesh.n_nodes(); ++dof)
    if (keep(dof)) kept.push_back(dof);
  for (Labelled* m : {&files.K, &files.M}) {
    m->A = Eigen::MatrixXd(Eigen::MatrixXd(m->A)(kept, kept)).sparseView();
    m->dof = kept;
  }
  files.imported.dofs = path_of("dofs.txt");
  if (is_root()) {
    write_triplets(files.imported.stiffness, files.K, Half::lower);
    write_triplets(files.imported.mass, files.M, Half::lower);
    write_dofs(files.imported.dofs, kept);
  }
  const auto system = read(mesh, files.imported);
  EXPECT_THROW(reduction::scalar_mass(system, is_root() ? mesh.n_nodes() : 0), Error);
}

}  // namespace
}  // namespace elastogear::imported_matrices_test
