#include "elastogear/reduction/block_lanczos.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "../message_of.h"
#include "elastogear/base/error.h"
#include "elastogear/reduction/eigenmodes.h"

namespace elastogear::block_lanczos_test {
namespace {

using UniqueEPS = Handle<EPS, EPSDestroy>;

constexpr double kEigensolver = 1e-9;    // relative, of eigenvalues
constexpr double kOrthogonality = 1e-8;  // of phi_i' M phi_j
constexpr int kSide = 17;                // of a square grid of points, so that eigenvalues come in pairs

// -laplace(u) on a square, less `shift` times the mass, which is diagonal: of another sparsity than K.
struct Pair {
  UniqueMat K, M;
};

UniqueMat grid_matrix() {
  UniqueMat A;
  check(MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, kSide * kSide, kSide * kSide, 5, nullptr,
                     4, nullptr, A.out()));
  return A;
}

void finish(Mat A) {
  check(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  check(MatSetOption(A, MAT_SYMMETRIC, PETSC_TRUE));
}

Pair membrane(double shift = 0) {
  constexpr double kMass = 2;
  Pair pair{grid_matrix(), grid_matrix()};
  PetscInt begin = 0, end = 0;
  check(MatGetOwnershipRange(pair.K, &begin, &end));
  for (PetscInt row = begin; row < end; ++row) {
    const int i = row % kSide, j = row / kSide;
    check(MatSetValue(pair.K, row, row, 4 - kMass * shift, INSERT_VALUES));
    if (i > 0) check(MatSetValue(pair.K, row, row - 1, -1, INSERT_VALUES));
    if (i + 1 < kSide) check(MatSetValue(pair.K, row, row + 1, -1, INSERT_VALUES));
    if (j > 0) check(MatSetValue(pair.K, row, row - kSide, -1, INSERT_VALUES));
    if (j + 1 < kSide) check(MatSetValue(pair.K, row, row + kSide, -1, INSERT_VALUES));
    check(MatSetValue(pair.M, row, row, kMass, INSERT_VALUES));
  }
  finish(pair.K);
  finish(pair.M);
  return pair;
}

UniqueEPS create(const Pair& pair, int n, const char* type = reduction::kBlockLanczos) {
  reduction::register_block_lanczos();
  UniqueEPS eps;
  check(EPSCreate(PETSC_COMM_WORLD, eps.out()));
  check(EPSSetOperators(eps, pair.K, pair.M));
  check(EPSSetProblemType(eps, EPS_GHEP));
  check(EPSSetType(eps, type));
  check(EPSSetDimensions(eps, n, PETSC_DEFAULT, PETSC_DEFAULT));
  return eps;
}

Eigen::VectorXd eigenvalues(EPS eps) {
  PetscInt n = 0;
  check(EPSGetConverged(eps, &n));
  Eigen::VectorXd lambda(n);
  for (PetscInt i = 0; i < n; ++i) check(EPSGetEigenvalue(eps, i, &lambda(i), nullptr));
  return lambda;
}

Eigen::VectorXd solve(EPS eps) {
  reduction::block_lanczos_check(eps, EPSSolve(eps));
  return eigenvalues(eps);
}

Eigen::VectorXd by_krylov_schur(const Pair& pair, int n) {
  const UniqueEPS eps = create(pair, n, EPSKRYLOVSCHUR);
  ST st = nullptr;
  KSP ksp = nullptr;
  PC pc = nullptr;
  check(EPSSetWhichEigenpairs(eps, EPS_TARGET_REAL));
  check(EPSSetTarget(eps, 0));
  check(EPSSetTolerances(eps, 1e-12, PETSC_DEFAULT));
  check(EPSGetST(eps, &st));
  check(STSetType(st, STSINVERT));
  check(STGetKSP(st, &ksp));
  check(KSPSetType(ksp, KSPPREONLY));
  check(KSPGetPC(ksp, &pc));
  check(PCSetType(pc, PCCHOLESKY));
  check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  check(EPSSolve(eps));
  return eigenvalues(eps).head(n);
}

void expect_equal(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  ASSERT_EQ(a.size(), b.size());
  for (Eigen::Index i = 0; i < a.size(); ++i)
    EXPECT_NEAR(a(i), b(i), kEigensolver * std::abs(b(b.size() - 1))) << i;
}

double largest_residual(EPS eps) {
  double largest = 0;
  for (PetscInt i = 0; i < eigenvalues(eps).size(); ++i) {
    PetscReal residual = 0;
    check(EPSComputeError(eps, i, EPS_ERROR_RELATIVE, &residual));
    largest = std::max(largest, residual);
  }
  return largest;
}

TEST(BlockLanczos, gives_the_eigenpairs_of_krylov_schur_with_all_multiple_ones) {
  const Pair pair = membrane();
  constexpr int kPairs = 40;
  const UniqueEPS eps = create(pair, kPairs);
  reduction::block_lanczos_set(eps, {.window = 10, .block = 3});
  const Eigen::VectorXd lambda = solve(eps);
  EXPECT_NEAR(lambda(2) / lambda(1), 1, kEigensolver) << "no pair";
  expect_equal(lambda, by_krylov_schur(pair, kPairs));
  EXPECT_LT(largest_residual(eps), 1e-7);
}

TEST(BlockLanczos, vectors_are_orthonormal_in_the_mass) {
  const Pair pair = membrane();
  const UniqueEPS eps = create(pair, 20);
  solve(eps);
  UniqueVec a, b, M_b;
  check(MatCreateVecs(pair.M, a.out(), b.out()));
  check(VecDuplicate(b, M_b.out()));
  for (PetscInt j = 0; j < 20; ++j) {
    check(EPSGetEigenvector(eps, j, b, nullptr));
    check(MatMult(pair.M, b, M_b));
    for (PetscInt i = 0; i <= j; ++i) {
      PetscScalar product = 0;
      check(EPSGetEigenvector(eps, i, a, nullptr));
      check(VecDot(a, M_b, &product));
      EXPECT_NEAR(product, i == j, kOrthogonality) << i << " " << j;
    }
  }
}

// Ends between different eigenvalues.
reduction::Interval interval(const Eigen::VectorXd& lambda, int first, int last) {
  while (lambda(first) - lambda(first - 1) < 1e-6) ++first;
  while (lambda(last) - lambda(last - 1) < 1e-6) ++last;
  return {(lambda(first - 1) + lambda(first)) / 2, (lambda(last - 1) + lambda(last)) / 2};
}

TEST(BlockLanczos, finds_all_of_an_interval_and_as_many_as_inertia_counts) {
  const Pair pair = membrane();
  const Eigen::VectorXd all = by_krylov_schur(pair, 80);
  for (const auto& [first, last] : {std::pair{5, 40}, std::pair{20, 70}, std::pair{30, 32}}) {
    const auto [lower, upper] = interval(all, first, last);
    const UniqueEPS eps = create(pair, 1);
    check(EPSSetWhichEigenpairs(eps, EPS_ALL));
    check(EPSSetInterval(eps, lower, upper));
    reduction::block_lanczos_set(eps, {.window = 12, .block = 4});
    const Eigen::VectorXd lambda = solve(eps);
    const int below = reduction::count_eigenvalues_below(pair.K, pair.M, lower);
    EXPECT_EQ(lambda.size(), reduction::count_eigenvalues_below(pair.K, pair.M, upper) - below);
    expect_equal(lambda, all.segment(below, lambda.size()));
  }
}

TEST(BlockLanczos, of_an_empty_interval_finds_none) {
  const Pair pair = membrane();
  const UniqueEPS eps = create(pair, 1);
  check(EPSSetWhichEigenpairs(eps, EPS_ALL));
  check(EPSSetInterval(eps, -2, -1));
  EXPECT_EQ(solve(eps).size(), 0);
}

// Its middle eigenvalue comes 17 times, more often than a block has columns at first.
TEST(BlockLanczos, finds_eigenvalues_of_a_multiplicity_above_its_block) {
  const Pair pair = membrane();
  const UniqueEPS eps = create(pair, 160);
  reduction::block_lanczos_set(eps, {.window = 40, .block = 4});
  const Eigen::VectorXd lambda = solve(eps);
  EXPECT_EQ(((lambda.array() - 2).abs() < kEigensolver).count(), kSide);
  EXPECT_EQ(reduction::count_eigenvalues_below(pair.K, pair.M, 2 - 1e-6), (kSide - 1) * kSide / 2);
  EXPECT_EQ((lambda.array() < 2 - 1e-6).count(), (kSide - 1) * kSide / 2);
}

TEST(BlockLanczos, walks_up_from_the_bottom_of_an_indefinite_pair) {
  const double shift = 0.8;  // some eigenvalues become negative
  const Pair pair = membrane(), shifted = membrane(shift);
  ASSERT_GT(reduction::count_eigenvalues_below(shifted.K, shifted.M, 0), 20);
  const UniqueEPS eps = create(shifted, 60);
  reduction::block_lanczos_set(eps, {.window = 15, .block = 4});
  expect_equal(solve(eps).array() + shift, by_krylov_schur(pair, 60));
}

TEST(BlockLanczos, above_a_target_is_an_error_when_eigenvalues_lie_below_it) {
  const Pair pair = membrane();
  const UniqueEPS eps = create(pair, 5);
  check(EPSSetWhichEigenpairs(eps, EPS_TARGET_REAL));
  check(EPSSetTarget(eps, 0.5));
  const int below = reduction::count_eigenvalues_below(pair.K, pair.M, 0.5);
  ASSERT_GT(below, 0);
  const std::string message = test::message_of([&] { solve(eps); });
  EXPECT_NE(message.find(std::to_string(below) + " eigenvalues lie below"), std::string::npos) << message;
}

// Options of this test alone, which end with it.
struct ScopedOptions {
  explicit ScopedOptions(const char* text) : names(text) { check(PetscOptionsInsertString(nullptr, text)); }
  ~ScopedOptions() {
    for (std::size_t at = names.find('-'); at != std::string::npos; at = names.find(" -", at + 1)) {
      const std::size_t begin = names[at] == ' ' ? at + 1 : at;
      PetscOptionsClearValue(nullptr, names.substr(begin, names.find(' ', begin) - begin).c_str());
      at = begin;
    }
  }
  std::string names;
};

TEST(BlockLanczos, takes_the_options_of_slepc) {
  const Pair pair = membrane();
  const Eigen::VectorXd all = by_krylov_schur(pair, 40);
  for (const char* text :
       {"-eps_nev 40 -eps_tol 1e-11", "-eps_nev 40 -eps_ncv 60 -eps_block_lanczos_window 9",
        "-eps_nev 40 -st_pc_type cholesky -st_mat_mumps_icntl_13 1", "-eps_nev 40 -st_matmode copy",
        "-eps_nev 40 -eps_target -0.1"}) {
    SCOPED_TRACE(text);
    const ScopedOptions options(text);
    const UniqueEPS eps = create(pair, 3);
    check(EPSSetFromOptions(eps));
    expect_equal(solve(eps).head(40), all);
  }
}

TEST(BlockLanczos, takes_fewer_blocks_where_the_tolerance_is_larger) {
  const Pair pair = membrane();
  const Eigen::VectorXd all = by_krylov_schur(pair, 10);
  PetscInt before = 0;
  for (double tolerance : {1e-3, 1e-6, 1e-10}) {
    SCOPED_TRACE(tolerance);
    PetscInt blocks = 0;
    const UniqueEPS eps = create(pair, 10);
    reduction::block_lanczos_set(eps, {.window = 10, .block = 2});
    check(EPSSetTolerances(eps, tolerance, PETSC_DEFAULT));
    const Eigen::VectorXd error = solve(eps).head(10).cwiseQuotient(all).array() - 1;
    EXPECT_LT(error.cwiseAbs().maxCoeff(), tolerance);
    check(EPSGetIterationNumber(eps, &blocks));
    EXPECT_GT(blocks, before);
    before = blocks;
  }
}

TEST(BlockLanczos, continued_from_any_window_gives_the_same_to_the_bit) {
  const Pair pair = membrane();
  std::vector<reduction::SearchState> states;
  const reduction::BlockLanczosSettings settings{.window = 8, .block = 3};
  const UniqueEPS whole = create(pair, 40);
  reduction::block_lanczos_set(whole, settings);
  reduction::block_lanczos_set_handler(
      whole, {.mode = [](int, Vec) {}, .window = [&](const auto& state) { states.push_back(state); }});
  const Eigen::VectorXd lambda = solve(whole);
  ASSERT_GE(states.size(), 4u);
  int size = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  for (const reduction::SearchState& state : states) {
    const UniqueEPS rest = create(pair, 40);
    reduction::BlockLanczosSettings continued = settings;
    continued.start = state;
    int first = 40;
    reduction::block_lanczos_set(rest, continued);
    reduction::block_lanczos_set_handler(rest, {.mode = [&](int i, Vec) { first = std::min(first, i); }});
    expect_equal(solve(rest), lambda);
    EXPECT_EQ(first, state.eigenvalue.size());
    if (size == 1) {  // MUMPS adds up in the order of arrival on several ranks
      EXPECT_EQ(eigenvalues(rest), lambda);
      EXPECT_EQ(reduction::block_lanczos_state(rest).residual,
                reduction::block_lanczos_state(whole).residual);
    }
  }
}

TEST(BlockLanczos, keeps_no_vectors_that_it_hands_out) {
  const Pair pair = membrane();
  const UniqueEPS eps = create(pair, 10);
  int received = 0;
  reduction::block_lanczos_set_handler(eps, {.mode = [&](int i, Vec) { EXPECT_EQ(i, received++); }});
  EXPECT_EQ(solve(eps).size(), 10);
  EXPECT_EQ(received, 10);
  UniqueVec phi;
  check(MatCreateVecs(pair.K, phi.out(), nullptr));
  const std::string message = test::message_of([&] { check(EPSGetEigenvector(eps, 3, phi, nullptr)); });
  EXPECT_NE(message.find("Vector 3 was handed out"), std::string::npos) << message;
}

TEST(BlockLanczos, ends_with_what_its_handler_throws) {
  const Pair pair = membrane();
  const UniqueEPS eps = create(pair, 10);
  reduction::block_lanczos_set_handler(eps, {.mode = [](int i, Vec) { require(i < 4, "enough of them"); }});
  EXPECT_EQ(test::message_of([&] { solve(eps); }), "enough of them");
}

TEST(BlockLanczos, solves_again_after_its_matrices_and_wishes_have_changed) {
  const Pair pair = membrane(), other = membrane(-1);
  const UniqueEPS eps = create(pair, 10);
  const Eigen::VectorXd lambda = solve(eps);
  check(EPSSetDimensions(eps, 30, PETSC_DEFAULT, PETSC_DEFAULT));
  const Eigen::VectorXd more = solve(eps);
  ASSERT_EQ(more.size(), 30);
  expect_equal(more.head(10), lambda);
  check(EPSSetOperators(eps, other.K, other.M));
  expect_equal(solve(eps).array() - 1, more);
}

struct Seen {
  PetscInt n_calls = 0, most_converged = 0;
};

PetscErrorCode watch(EPS eps, PetscInt, PetscInt converged, PetscScalar* theta, PetscScalar* imaginary,
                     PetscReal*, PetscInt n, void* context) {
  auto& seen = *static_cast<Seen*>(context);
  ST st = nullptr;
  ++seen.n_calls;
  seen.most_converged = std::max(seen.most_converged, converged);
  PetscCall(EPSGetST(eps, &st));
  for (PetscInt i = 0; i < n; ++i) {
    PetscScalar lambda = theta[i], zero = imaginary[i];
    PetscCall(STBackTransform(st, 1, &lambda, &zero));
    EXPECT_GT(lambda, 0);
    EXPECT_LT(lambda, 4);
  }
  return 0;
}

TEST(BlockLanczos, tells_monitors_the_eigenvalues_it_has) {
  const Pair pair = membrane();
  const UniqueEPS eps = create(pair, 30);
  Seen seen;
  reduction::block_lanczos_set(eps, {.window = 10, .block = 4});
  check(EPSMonitorSet(eps, watch, &seen, nullptr));
  solve(eps);
  EXPECT_GE(seen.n_calls, 2);
  EXPECT_GE(seen.most_converged, 30);
}

TEST(BlockLanczos, needs_a_definite_pair_and_an_own_type) {
  const Pair pair = membrane();
  const UniqueEPS eps = create(pair, 5);
  check(EPSSetProblemType(eps, EPS_GNHEP));
  EXPECT_NE(test::message_of([&] { solve(eps); }), "no error");
  const UniqueEPS other = create(pair, 5, EPSKRYLOVSCHUR);
  EXPECT_NE(test::message_of([&] { reduction::block_lanczos_set(other, {}); }).find("must be block_lanczos"),
            std::string::npos);
}

}  // namespace
}  // namespace elastogear::block_lanczos_test
