// The exact low-rank solver against a dense factorisation of the matrix that it multiplies with.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <numeric>

#include "box_body.h"
#include "elastogear/body/tangent.h"
#include "elastogear/dynamics/low_rank_solver.h"
#include "petsc_option.h"

namespace elastogear::low_rank_solver_test {
using namespace dynamics;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kRoundoff = 1e-10;  // relative, of a solve with condition number up to 1e5
constexpr int kContacts = 3;

using Bodies = std::vector<body::Equations>;

body::Equations equations(model::Basis basis, body::JointType joint, int cells = 2) {
  const test::BoxSpec spec{.size = {2, 1, 1}, .cells = {3, cells, cells}, .material = {100, 0.3, 1}};
  const int n_modes = basis == model::Basis::modal ? 12 : 0;
  auto box = std::make_shared<model::ElasticBody>(test::make_box(spec, basis, n_modes));
  box->alpha = 0.1;
  box->beta = 0.01;
  return body::make_equations(box, {.type = joint, .axis = {1, 1, 0}}, body::InertiaLevel::linear);
}

Bodies bodies(model::Basis basis, int cells = 2) {
  return {equations(basis, body::JointType::revolute, cells),
          equations(basis, body::JointType::fixed, cells)};
}

std::vector<SolverBody> pointers(const Bodies& bodies) {
  return {{&bodies[0], bodies[0].n_s()}, {&bodies[1], bodies[1].n_s()}};
}

// Contact columns of one slave node against four master nodes, with an indefinite symmetric k.
EffectiveMatrix random_matrix(const Bodies& bodies, double shift_v, double shift_a,
                              const std::vector<int>& node = {1, 4, 7}) {
  std::srand(3);
  EffectiveMatrix A;
  A.shift_v = shift_v;
  A.shift_a = shift_a;
  const Eigen::Index r = 2 * kContacts;
  for (const body::Equations& eq : bodies) {
    BodyTerms terms;
    terms.node = node;
    const Eigen::Index n_e = body::border(eq).cols() + 3 * static_cast<Eigen::Index>(node.size());
    terms.C = 50 * MatrixXd::Identity(eq.n_s(), eq.n_s());
    terms.beta = MatrixXd::Random(n_e, eq.n_s());
    terms.rho = MatrixXd::Random(n_e, eq.n_s());
    terms.W_s = MatrixXd::Random(eq.n_s(), r);
    terms.V_s = MatrixXd::Random(eq.n_s(), r);
    terms.L = MatrixXd::Random(n_e, r).sparseView(1, 0.5);
    A.body.push_back(terms);
  }
  const MatrixXd half = 10 * MatrixXd::Random(r, r);
  A.k = (half + half.transpose()).sparseView();
  return A;
}

Eigen::Index system_size(const Bodies& bodies) {
  Eigen::Index n = 0;
  for (const body::Equations& eq : bodies) n += eq.n_s() + eq.n_q();
  return n;
}

MatrixXd dense(const LowRankSolver& solver, Eigen::Index n) {
  MatrixXd A(n, n);
  for (Eigen::Index j = 0; j < n; ++j) A.col(j) = solver.multiply(VectorXd::Unit(n, j));
  return A;
}

void expect_equal_to_dense(const Bodies& bodies, const LowRankSolver& solver) {
  const Eigen::Index n = system_size(bodies);
  const VectorXd y = VectorXd::Random(n), x = dense(solver, n).partialPivLu().solve(y);
  EXPECT_LT((solver.solve(y) - x).norm(), kRoundoff * x.norm());
}

class Solver : public testing::TestWithParam<model::Basis> {};

TEST_P(Solver, equals_a_dense_solve) {
  const Bodies pair = bodies(GetParam());
  LowRankSolver solver(pointers(pair));
  solver.set(random_matrix(pair, 10, 100));
  expect_equal_to_dense(pair, solver);
}

TEST_P(Solver, follows_new_nodes_and_new_shifts) {
  const Bodies pair = bodies(GetParam());
  LowRankSolver solver(pointers(pair));
  solver.set(random_matrix(pair, 10, 100));
  EffectiveMatrix A = random_matrix(pair, 10, 100);
  A.body[0].node = {0, 4, 9};
  solver.set(A);
  expect_equal_to_dense(pair, solver);
  A.shift_a = 400;
  solver.set(A);
  expect_equal_to_dense(pair, solver);
}

// Loads on nodes whose columns are kept, alone and with others that count or do not.
TEST_P(Solver, sums_up_responses_to_loads_on_kept_nodes) {
  const Bodies pair = bodies(GetParam());
  const std::vector<int> kept{0, 4, 9};
  ElasticBlock D(pair[0]);
  D.set_shifts(10, 100);
  D.compliance(kept);
  const VectorXd load = BorderColumns(pair[0]).node_columns(kept) * VectorXd::Random(9);
  for (double elsewhere : {0., 1e-9, 1e-3}) {
    const VectorXd y = load + elsewhere * load.norm() * VectorXd::Unit(load.size(), load.size() / 2),
                   x = D.solve(y);
    EXPECT_LT((D.solve_load(y) - x).norm(),
              (elsewhere < 1e-6 ? 100 * elsewhere + kRoundoff : kRoundoff) * x.norm());
  }
}

TEST_P(Solver, takes_up_more_nodes_than_it_solves_for_at_once) {
  const Bodies pair = bodies(GetParam(), 4);
  std::vector<int> node(pair[0].body->surface.node.size());
  ASSERT_GT(node.size(), 16U);
  std::iota(node.begin(), node.end(), 0);
  LowRankSolver solver(pointers(pair));
  solver.set(random_matrix(pair, 10, 100, node));
  expect_equal_to_dense(pair, solver);
}

TEST_P(Solver, matrix_is_the_block_form_it_states) {
  const Bodies pair = bodies(GetParam());
  LowRankSolver solver(pointers(pair));
  const EffectiveMatrix A = random_matrix(pair, 10, 100);
  solver.set(A);
  const body::Equations& eq = pair[0];
  const Eigen::Index n_s = eq.n_s(), n_q = eq.n_q();
  MatrixXd E(n_q, A.body[0].beta.rows());
  E << body::border(eq), BorderColumns(eq).node_columns(A.body[0].node);
  MatrixXd W(n_s + n_q, A.k.rows()), V(n_s + n_q, A.k.rows()), block(n_s + n_q, n_s + n_q);
  W << A.body[0].W_s, E * A.body[0].L;
  V << A.body[0].V_s, E * A.body[0].L;
  block << A.body[0].C, (E * A.body[0].rho).transpose(), E * A.body[0].beta,
      MatrixXd(100 * eq.body->M_r + 10 * eq.D_r + eq.body->K_r);
  block += W * A.k * V.transpose();
  const MatrixXd found = dense(solver, system_size(pair)).topLeftCorner(n_s + n_q, n_s + n_q);
  EXPECT_LT((found - block).norm(), kRoundoff * block.norm());
}

TEST(SolverOfPetsc, is_exact_when_it_factorises_or_divides) {
  const Bodies full = bodies(model::Basis::full), modal = bodies(model::Basis::modal);
  const test::Option multigrid("-elastic_pc_type", "gamg");
  EXPECT_FALSE(LowRankSolver(pointers(full)).is_exact());
  EXPECT_TRUE(LowRankSolver(pointers(modal)).is_exact());
}

INSTANTIATE_TEST_SUITE_P(Bases, Solver, testing::Values(model::Basis::modal, model::Basis::full));

}  // namespace
}  // namespace elastogear::low_rank_solver_test
