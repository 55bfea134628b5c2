#include "reduction/slepc/spectrum_slicing.h"
#include "elastogear/reduction/eigenmodes.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "../fem/system.h"
#include "elastogear/base/error.h"
#include "elastogear/reduction/eigenmodes.h"
#include "reduction/eigensolver/factorisation.h"
#include "reduction/eigensolver/ordering.h"

namespace elastogear::spectrum_slicing_test {
namespace {

constexpr double kEigensolver = 1e-9;  // relative, of eigenvalues
constexpr double kOrthogonality = 1e-8;
constexpr double kRoundoff = 1e-10;  // relative, of a solution, times the condition number
constexpr int kModes = 24;

// A beam of square section: its bending eigenvalues come in equal pairs.
test::System square_beam() { return test::assemble(test::brick({6, 2, 2}, {1, 0.2, 0.2}), {"xmin"}); }

// Held on one face: symmetric about both mid-planes and the diagonals, so that pairs are equal here too.
test::System cube() { return test::assemble(test::brick({4, 4, 4}, {1, 1, 1}), {"xmin"}); }

struct Solution {
  reduction::Eigenmodes modes;
  Eigen::MatrixXd gram;  // phi_i' M phi_j
};

Solution solve(const test::System& system, const reduction::EigenOptions& options) {
  std::vector<UniqueVec> phi;
  Solution solution;
  const auto keep = [&](int i, Vec v) {
    EXPECT_EQ(i, static_cast<int>(phi.size()));
    check(VecDuplicate(v, phi.emplace_back().out()));
    check(VecCopy(v, phi.back()));
  };
  const auto& [K, M] = system.matrices;
  solution.modes = reduction::find_eigenmodes(K, M, options, keep);
  UniqueVec M_phi;
  check(MatCreateVecs(M, nullptr, M_phi.out()));
  solution.gram.resize(options.n_modes, options.n_modes);
  for (int i = 0; i < options.n_modes; ++i) {
    check(MatMult(M, phi[i], M_phi));
    for (int j = 0; j < options.n_modes; ++j) check(VecDot(phi[j], M_phi, &solution.gram(i, j)));
  }
  return solution;
}

void expect_orthonormal(const Solution& solution) {
  const auto n = solution.gram.rows();
  EXPECT_LT((solution.gram - Eigen::MatrixXd::Identity(n, n)).lpNorm<Eigen::Infinity>(), kOrthogonality);
}

void expect_equal(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  ASSERT_EQ(a.size(), b.size());
  for (Eigen::Index i = 0; i < a.size(); ++i) EXPECT_NEAR(a(i) / b(i), 1, kEigensolver) << i;
}

TEST(Windows, many_give_the_modes_of_one) {
  for (const test::System& system : {square_beam(), cube()}) {
    const Solution one = solve(system, {.n_modes = kModes, .window = 256});
    expect_orthonormal(one);
    for (int size : {3, 8}) {
      const Solution many = solve(system, {.n_modes = kModes, .window = size, .block = 4});
      expect_equal(many.modes.eigenvalue, one.modes.eigenvalue);
      expect_orthonormal(many);
      EXPECT_GT(many.modes.iterations, one.modes.iterations) << "one window held all";
    }
  }
}

TEST(Windows, are_of_equal_size_up_to_the_last) {
  const test::System system = cube();
  const auto& [K, M] = system.matrices;
  std::vector<Eigen::Index> ends;
  const auto note = [&](const reduction::SearchState& state) { ends.push_back(state.eigenvalue.size()); };
  reduction::find_eigenmodes(K, M, {.n_modes = 46, .window = 40, .block = 4, .commit = note},
                             [](int, Vec) {});
  EXPECT_EQ(ends.size(), 1u) << "a window may be a fifth larger";
  ends.clear();
  reduction::find_eigenmodes(K, M, {.n_modes = 52, .window = 40, .block = 4, .commit = note},
                             [](int, Vec) {});
  ASSERT_EQ(ends.size(), 2u);
  const double gap_search = 8;  // modes by which an end may move to the widest gap
  EXPECT_NEAR(static_cast<double>(ends[0]), 26, gap_search);
}

TEST(WindowSize, grows_with_the_factor_and_keeps_what_is_asked) {
  const int n = 350000;
  const reduction::FactorSize light{3e7, 1e10}, heavy{6e8, 2e12};
  EXPECT_GT(reduction::choose_window(heavy, n, {}).modes, reduction::choose_window(light, n, {}).modes);
  const auto asked = reduction::choose_window(heavy, n, {70, 24});
  EXPECT_EQ(asked.modes, 70);
  EXPECT_EQ(asked.block, 24);
}

TEST(WindowSize, leaves_the_basis_smaller_than_one_and_a_half_factors) {
  for (double entries : {1.5e8, 3e8, 6e8}) {
    const int n = 350000;
    const auto size = reduction::choose_window({entries, 1e3 * entries}, n, {});
    EXPECT_LT(static_cast<double>(n) * size.modes, 1.5 * entries);
  }
}

TEST(Windows, give_the_modes_of_krylov_schur) {
  const test::System system = square_beam();
  const Solution theirs = solve(system, {.n_modes = kModes});
  const Solution ours = solve(system, {.n_modes = kModes, .window = 10, .block = 8});
  expect_equal(ours.modes.eigenvalue, theirs.modes.eigenvalue);
  EXPECT_LT(ours.modes.residual.maxCoeff(), 1e-7);
}

TEST(Windows, do_not_depend_on_the_number_of_ranks) {
  const auto mesh = test::brick({6, 2, 2}, {1, 0.2, 0.2});
  const reduction::EigenOptions options{.n_modes = kModes, .window = 10, .block = 8};
  expect_equal(solve(test::assemble(mesh, {"xmin"}), options).modes.eigenvalue,
               solve(test::assemble(mesh, {"xmin"}, PETSC_COMM_SELF), options).modes.eigenvalue);
}

TEST(Windows, continued_from_any_state_give_the_same_modes_to_the_bit) {
  const test::System system = square_beam();
  reduction::EigenOptions options{.n_modes = kModes, .window = 5, .block = 3};
  std::vector<reduction::SearchState> states;
  options.commit = [&](const reduction::SearchState& state) { states.push_back(state); };
  const auto ignore = [](int, Vec) {};
  const auto& [K, M] = system.matrices;
  const auto whole = reduction::find_eigenmodes(K, M, options, ignore);
  ASSERT_GE(states.size(), 4u);
  int size = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  for (const auto& state : std::vector(states)) {
    options.start = state;
    int first = -1;
    const auto rest = reduction::find_eigenmodes(K, M, options, [&](int k, Vec) {
      if (first < 0) first = k;
    });
    const auto known = state.eigenvalue.size();
    EXPECT_EQ(first, known < kModes ? static_cast<int>(known) : -1);
    expect_equal(rest.eigenvalue, whole.eigenvalue);
    // MUMPS adds up in the order of arrival on several ranks.
    if (size > 1) continue;
    EXPECT_EQ(rest.eigenvalue, whole.eigenvalue);
    EXPECT_EQ(rest.residual, whole.residual);
    EXPECT_EQ(rest.orthogonality, whole.orthogonality);
  }
}

TEST(Windows, keep_equal_eigenvalues_together_when_asked_to) {
  const test::System system = square_beam();
  for (int window : {0, 8}) {
    const Eigen::VectorXd first = solve(system, {.n_modes = 2, .window = window}).modes.eigenvalue;
    ASSERT_NEAR(first(1) / first(0), 1, kEigensolver) << "the first two are no pair";
    const reduction::EigenOptions options{.n_modes = 1, .window = window, .whole_pairs = true};
    int count = 0;
    const auto& [K, M] = system.matrices;
    const auto modes = reduction::find_eigenmodes(K, M, options, [&](int, Vec) { ++count; });
    EXPECT_EQ(modes.eigenvalue.size(), 2);
    EXPECT_EQ(count, 2);
  }
}

TEST(Windows, measure_the_orthogonality_of_their_modes) {
  const test::System system = cube();
  for (int window : {0, 6}) {
    const Solution solution = solve(system, {.n_modes = kModes, .window = window, .block = 4});
    const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(kModes, kModes);
    const double largest = (solution.gram - I).cwiseAbs().maxCoeff();
    EXPECT_GT(solution.modes.orthogonality, 0);
    EXPECT_LT(solution.modes.orthogonality, kOrthogonality);
    EXPECT_LT(std::abs(solution.modes.orthogonality - largest), kOrthogonality);
  }
}

TEST(Windows, of_an_interval_leave_the_six_rigid_modes_of_a_free_body_out) {
  const test::System system = test::assemble(test::brick({4, 3, 2}, {1, 0.6, 0.3}), {});
  const auto& [K, M] = system.matrices;
  const double scale = 1e6;  // rad^2/s^2, far below the first elastic mode
  double upper = scale;
  while (reduction::count_eigenvalues_below(K, M, upper) < 6 + 10) upper *= 1.5;
  const int n = reduction::count_eigenvalues_below(K, M, upper) - 6;
  const Solution solution =
      solve(system, {.n_modes = n, .interval = reduction::Interval{scale, upper}, .window = 4, .block = 4});
  ASSERT_EQ(solution.modes.eigenvalue.size(), n);
  EXPECT_GT(solution.modes.eigenvalue(0), scale);
  EXPECT_LT(solution.modes.eigenvalue(n - 1), upper);
  expect_orthonormal(solution);
  EXPECT_EQ(reduction::count_eigenvalues_below(K, M, 0.999 * solution.modes.eigenvalue(0)), 6);
}

TEST(Windows, that_lost_a_mode_are_an_error_naming_both_counts) {
  const test::System system = square_beam();
  const Eigen::VectorXd all = solve(system, {.n_modes = 13}).modes.eigenvalue;
  reduction::ShiftedFactor factor(system.matrices.K, system.matrices.M);
  int n = 12;
  while (all(n) < 1.001 * all(n - 1)) --n;
  const double sigma = (all(n - 1) + all(n)) / 2;
  const int exact = factor.factorise(sigma);
  EXPECT_NO_THROW(reduction::require_complete(n, exact, sigma));
  try {
    reduction::require_complete(n - 1, exact, sigma);
    ADD_FAILURE() << "a lost mode went unnoticed";
  } catch (const Error& error) {
    const std::string expected = "found " + std::to_string(n - 1) + " of the " + std::to_string(n);
    EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
  }
}

TEST(ShiftedFactor, solves_for_many_right_hand_sides_in_both_orders_of_elimination) {
  const test::System system = square_beam();
  const auto& [K, M] = system.matrices;
  UniqueVec x, b;
  check(MatCreateVecs(K, x.out(), b.out()));
  PetscInt own = 0;
  check(VecGetLocalSize(x, &own));
  for (const auto ordering : {reduction::Ordering::metis, reduction::Ordering::mumps}) {
    reduction::ShiftedFactor factor(K, M, ordering);
    EXPECT_EQ(factor.factorise(0), 0);
    Eigen::MatrixXd B(own, 3);
    for (int j = 0; j < 3; ++j) {
      check(VecSet(x, j + 1));
      check(MatMult(K, x, b));
      const PetscScalar* values = nullptr;
      check(VecGetArrayRead(b, &values));
      B.col(j) = Eigen::Map<const Eigen::VectorXd>(values, own);
      check(VecRestoreArrayRead(b, &values));
    }
    factor.solve(B);
    for (int j = 0; j < 3; ++j) EXPECT_LT((B.col(j).array() - (j + 1)).abs().maxCoeff(), kRoundoff);
  }
}

TEST(NestedDissection, orders_every_row_once) {
  const test::System system = square_beam();
  std::vector<int> position = reduction::nested_dissection(system.matrices.K);
  int rank = 0;
  PetscInt n = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  check(MatGetSize(system.matrices.K, &n, nullptr));
  ASSERT_EQ(static_cast<int>(position.size()), rank == 0 ? n : 0);
  std::sort(position.begin(), position.end());
  for (std::size_t i = 0; i < position.size(); ++i) EXPECT_EQ(position[i], static_cast<int>(i));
}

}  // namespace
}  // namespace elastogear::spectrum_slicing_test
