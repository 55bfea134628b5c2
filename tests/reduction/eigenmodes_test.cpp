#include "elastogear/reduction/eigenmodes.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "../fem/system.h"
#include "../message_of.h"

namespace elastogear::eigenmodes_test {
namespace {

constexpr double kEigensolver = 1e-9;  // relative, of eigenvalues
constexpr double kOrthogonality = 1e-9;

// A beam of square section: its bending eigenvalues come in equal pairs.
mesh::Mesh square_beam() { return test::brick({8, 3, 3}, {1, 0.2, 0.2}); }

bool is_root() {
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  return rank == 0;
}

struct Gathered {
  reduction::Eigenmodes modes;
  Eigen::MatrixXd Phi;  // on rank 0
};

Gathered solve(const test::System& system, const reduction::EigenOptions& options) {
  UniqueVec layout;
  check(MatCreateVecs(system.matrices.K, layout.out(), nullptr));
  const fem::VectorGather gather(layout, system.rows);
  Gathered result;
  const auto keep = [&](int i, Vec phi) {
    const Eigen::VectorXd u = gather(phi);
    result.Phi.conservativeResize(u.size(), i + 1);
    result.Phi.col(i) = u;
  };
  result.modes = reduction::find_eigenmodes(system.matrices.K, system.matrices.M, options, keep);
  return result;
}

TEST(Eigenmodes, equal_a_dense_solution_with_all_multiple_eigenvalues) {
  const auto mesh = square_beam();
  const auto system = test::assemble(mesh, {"xmin"});
  const auto [modes, Phi] = solve(system, {.n_modes = 40});
  const Eigen::MatrixXd K = fem::gather_matrix(system.matrices.K, system.rows);
  const Eigen::MatrixXd M = fem::gather_matrix(system.matrices.M, system.rows);
  if (!is_root()) return;
  const Eigen::VectorXd exact = Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(K, M).eigenvalues();
  EXPECT_NEAR(exact(1) / exact(0), 1, kEigensolver);
  for (int i = 0; i < 40; ++i) EXPECT_NEAR(modes.eigenvalue(i) / exact(i), 1, kEigensolver) << i;
  EXPECT_LT(modes.residual.maxCoeff(), 1e-7);
  const auto dofs = fem::free_dofs(fem::held_directions(mesh, {"xmin"}));
  const Eigen::MatrixXd phi = Phi(dofs, Eigen::all);
  const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(40, 40);
  EXPECT_LT((phi.transpose() * M * phi - I).lpNorm<Eigen::Infinity>(), kOrthogonality);
}

// The first n of a body whose eigenvalues are `exact`.
void expect_first(const test::System& system, const Eigen::VectorXd& exact, int n) {
  SCOPED_TRACE(std::to_string(n) + " modes");
  const auto [modes, Phi] = solve(system, {.n_modes = n, .window = reduction::kAutomaticWindow});
  ASSERT_EQ(modes.eigenvalue.size(), n);
  EXPECT_LT(modes.residual.maxCoeff(), 1e-7);
  EXPECT_LT(modes.orthogonality, kOrthogonality);
  if (!is_root()) return;
  EXPECT_LT((modes.eigenvalue.cwiseQuotient(exact.head(n)).array() - 1).abs().maxCoeff(), kEigensolver);
}

// Bars of square section and a cube: their pairs of equal eigenvalues lie at the end of what is asked and at
// the end of the spectrum.
TEST(Eigenmodes, may_be_any_part_of_the_spectrum_of_small_degenerate_bodies) {
  const std::vector<std::pair<mesh::Mesh, std::vector<int>>> bodies = {
      {test::brick({18, 2, 2}, {1, 0.05, 0.05}), {1, 7, 50, 135, 162, 163, 324, 485, 486}},
      {test::brick({6, 1, 1}, {1, 0.1, 0.1}), {1, 20, 24, 25, 71, 72}},
      {test::brick({4, 4, 4}, {1, 1, 1}), {1, 99, 100, 101, 250, 299, 300}}};
  for (const auto& [mesh, counts] : bodies) {
    const auto system = test::assemble(mesh, {"xmin"});
    const Eigen::MatrixXd K = fem::gather_matrix(system.matrices.K, system.rows);
    const Eigen::MatrixXd M = fem::gather_matrix(system.matrices.M, system.rows);
    Eigen::VectorXd exact;
    if (is_root()) {
      const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> dense(K, M);
      const Eigen::MatrixXd& phi = dense.eigenvectors();
      exact = phi.cwiseProduct(K * phi).colwise().sum();  // the error of a vector enters squared
    }
    for (int n : counts) expect_first(system, exact, n);
  }
}

// Roundoff of a dense solution is that of the largest eigenvalue, here 2e9 times the lowest.
TEST(Eigenmodes, that_are_all_of_a_slender_bar_are_exact_at_both_ends) {
  const double L = 10, h = 0.1, I = h * h * h * h / 12, A = h * h;
  const model::Material material{210e9, 0, 7850};
  const auto system =
      test::assemble(test::brick({60, 1, 1}, {L, h, h}), {"xmin"}, PETSC_COMM_WORLD, {{"", material}});
  const auto all = solve(system, {.n_modes = 720, .window = reduction::kAutomaticWindow}).modes;
  const auto few = solve(system, {.n_modes = 10, .window = reduction::kAutomaticWindow}).modes;
  EXPECT_LT((all.eigenvalue.head(10).cwiseQuotient(few.eigenvalue).array() - 1).abs().maxCoeff(), 1e-8);
  EXPECT_LT(all.residual.maxCoeff(), 2 * few.residual.maxCoeff());
  EXPECT_GT(all.eigenvalue(719) / all.eigenvalue(0), 1e9);
  const double omega = std::pow(1.875104068711961 / L, 2) * std::sqrt(material.E * I / (material.rho * A));
  EXPECT_NEAR(std::sqrt(all.eigenvalue(0)) / omega, 1, 1e-3);
}

TEST(Eigenmodes, do_not_depend_on_the_number_of_ranks) {
  const auto mesh = test::distorted(test::brick({6, 4, 3}, {1, 0.4, 0.2}), 0.02);
  const auto system = test::assemble(mesh, {"xmin"});
  const auto serial = test::assemble(mesh, {"xmin"}, PETSC_COMM_SELF);
  auto [modes, Phi] = solve(system, {.n_modes = 20});
  auto [modes_serial, Phi_serial] = solve(serial, {.n_modes = 20});
  for (int i = 0; i < 20; ++i)
    EXPECT_NEAR(std::sqrt(modes.eigenvalue(i) / modes_serial.eigenvalue(i)), 1, kEigensolver);
  for (int i = 0; is_root() && i < 20; ++i) {
    Eigen::VectorXd a = Phi.col(i), b = Phi_serial.col(i);
    reduction::fix_sign(a);
    reduction::fix_sign(b);
    EXPECT_LT((a - b).norm(), 1e-6 * b.norm()) << i;
  }
}

TEST(Eigenmodes, may_be_all_of_a_small_body) {
  const auto system = test::assemble(test::brick({2, 1, 1}, {1, 0.3, 0.2}), {"xmin"});
  PetscInt n = 0;
  check(MatGetSize(system.matrices.K, &n, nullptr));
  EXPECT_EQ(solve(system, {.n_modes = static_cast<int>(n)}).modes.eigenvalue.size(), n);
}

TEST(Eigenmodes, more_than_the_degrees_of_freedom_are_an_error_naming_both_numbers) {
  const auto system = test::assemble(test::brick({2, 1, 1}, {1, 0.3, 0.2}), {"xmin"});
  const std::string message = test::message_of([&] { solve(system, {.n_modes = 25}); });
  EXPECT_NE(message.find("25"), std::string::npos) << message;
  EXPECT_NE(message.find("24"), std::string::npos) << message;
  EXPECT_NE(test::message_of([&] { solve(system, {.n_modes = 0}); }), "no error");
}

TEST(Eigenmodes, of_a_body_that_is_not_held_are_an_error) {
  const auto system = test::assemble(square_beam(), {});
  const std::string message = test::message_of([&] { solve(system, {.n_modes = 10}); });
  EXPECT_NE(message.find("singular"), std::string::npos) << message;
}

TEST(Eigenmodes, of_a_mechanism_are_an_error) {
  // Two bricks that share the edge x = 1, z = 0 only: the right one turns about it.
  mesh::Mesh mesh = test::brick({3, 2, 2}, {3, 1, 1});
  mesh::Cells cells;
  for (int i = 0; i < mesh.cells.size(); ++i)
    if ((i % 3 == 0) == (i / 6 == 0) && i % 3 != 2) cells.add(mesh.cells.type[i], mesh.cells[i]);
  mesh.cells = cells;
  const auto system = test::assemble(mesh, {"xmin"});
  const std::string message = test::message_of([&] { solve(system, {.n_modes = 10}); });
  EXPECT_NE(message.find("singular"), std::string::npos) << message;
}

TEST(Inertia, counts_the_eigenvalues_below_a_shift) {
  const auto system = test::assemble(square_beam(), {"xmin"});
  const Eigen::VectorXd lambda = solve(system, {.n_modes = 12}).modes.eigenvalue;
  for (int below = 1; below < 12; ++below) {
    if (lambda(below) < 1.001 * lambda(below - 1)) continue;
    const double sigma = (lambda(below) + lambda(below - 1)) / 2;
    EXPECT_EQ(reduction::count_eigenvalues_below(system.matrices.K, system.matrices.M, sigma), below);
  }
}

TEST(SignRule, makes_the_first_of_the_largest_entries_positive) {
  Eigen::VectorXd phi(4);
  phi << 0.5, -1, 1 + 1e-9, -1;
  reduction::fix_sign(phi);
  EXPECT_EQ(phi(1), 1);
  phi << 0.5, 0.9, -1.1, 0.2;
  reduction::fix_sign(phi);
  EXPECT_EQ(phi(2), 1.1);
  phi.setZero();
  reduction::fix_sign(phi);
  EXPECT_EQ(phi.norm(), 0);
}

}  // namespace
}  // namespace elastogear::eigenmodes_test
