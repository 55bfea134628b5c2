// Responses by nested dissection beside those of dense inverses, with leaves so small that there are many
// separators.
#include "reduction/static_response/nested_response.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <set>

#include "../fem/system.h"
#include "../figures.h"
#include "elastogear/base/error.h"
#include "reduction/nested/dissection.h"
#include "reduction/static_response/nested/directions.h"

namespace elastogear::nested_response_test {
namespace {

using namespace reduction;
using Eigen::MatrixXd;

constexpr double kRoundoff = 1e-9;  // relative, times the condition number
constexpr double kSingle = 5e-7;    // of the root of both rows' own responses: eight times the unit roundoff
constexpr double kUnitRoundoff = 6e-8;  // of single precision
constexpr double kLargest = 1e-6;       // of millions of entries, by whatever order a BLAS sums in
constexpr int kSmallLeaf = 30;          // rows

test::System block() { return test::assemble(test::brick({4, 4, 6}, {1, 0.9, 1.5}), {"zmin"}); }

MatrixXd dense(Mat A) {
  PetscInt n = 0;
  check(MatGetSize(A, &n, nullptr));
  MatrixXd all = MatrixXd::Zero(n, n);
  for (PetscInt i = 0; i < n; ++i) {
    PetscInt count = 0;
    const PetscInt* column = nullptr;
    const PetscScalar* value = nullptr;
    check(MatGetRow(A, i, &count, &column, &value));
    for (PetscInt k = 0; k < count; ++k) all(i, column[k]) = value[k];
    check(MatRestoreRow(A, i, &count, &column, &value));
  }
  return all;
}

// Single displacements far from each other, and sums of some that lie in several parts; one row is empty.
model::SparseRows wanted(Eigen::Index n_rows) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < 20; ++i) entries.emplace_back(i, static_cast<int>(i * 7 % n_rows), 1.0);
  for (int i = 21; i < 30; ++i)
    for (int k = 0; k < 12; ++k)
      entries.emplace_back(i, static_cast<int>((i * 31 + k * 53) % n_rows), 0.3 * k - 1);
  model::SparseRows P(30, n_rows);
  P.setFromTriplets(entries.begin(), entries.end());
  return P;
}

std::vector<int> all_in(const NestedResponse& response) {
  std::vector<int> all;
  for (const auto& group : response.groups()) all.insert(all.end(), group.begin(), group.end());
  return all;
}

// Columns P K^-1 P(load, :)' of all loads, group by group; other columns are zero.
Eigen::MatrixXf all_responses(NestedResponse& response, Eigen::Index n_rows) {
  Eigen::MatrixXf all = Eigen::MatrixXf::Zero(n_rows, n_rows);
  for (const std::vector<int>& group : response.groups()) all(Eigen::all, group) = response.next();
  fill_symmetric(response.groups(), [&](int load) { return all.col(load).data(); });
  return all;
}

// Differences of responses from exact ones.
struct Deviation {
  double largest = 0, rms = 0;
};

// Deviation of the responses to all loads from P K^-1 P', each over the root of the own responses of its load
// and row.
Deviation deviation_of(NestedResponse& response, const MatrixXd& exact) {
  const Eigen::VectorXd size = exact.diagonal().cwiseMax(1e-300).cwiseSqrt();
  const std::vector<int> loads = all_in(response);
  MatrixXd error =
      all_responses(response, exact.rows()).cast<double>()(Eigen::all, loads) - exact(Eigen::all, loads);
  for (Eigen::Index j = 0; j < error.cols(); ++j) error.col(j).array() /= (size * size[loads[j]]).array();
  return {error.cwiseAbs().maxCoeff(), error.norm() / std::sqrt(static_cast<double>(error.size()))};
}

TEST(Dissection, cuts_all_rows_into_parts_that_separators_keep_apart) {
  const test::System system = block();
  const MatrixXd K = dense(system.matrices.K);
  const std::vector<Part> parts = dissect(system.matrices.K, kSmallLeaf);
  EXPECT_GT(parts.size(), 10u);
  std::vector<std::set<int>> below;
  std::multiset<int> rows;
  for (const Part& part : parts) {
    std::set<int> all(part.row.begin(), part.row.end());
    rows.insert(part.row.begin(), part.row.end());
    if (!part.is_leaf()) {
      for (int i : below[part.left])
        for (int j : below[part.right]) EXPECT_EQ(K(i, j), 0);
      for (int child : {part.left, part.right}) all.insert(below[child].begin(), below[child].end());
    } else {
      EXPECT_LE(part.row.size(), static_cast<std::size_t>(kSmallLeaf));
    }
    below.push_back(all);
  }
  EXPECT_EQ(rows.size(), static_cast<std::size_t>(K.rows()));
  EXPECT_EQ(below.back().size(), static_cast<std::size_t>(K.rows()));
}

TEST(NestedResponse, is_that_of_the_inverse_whatever_the_parts) {
  const test::System system = block();
  const MatrixXd K = dense(system.matrices.K);
  const model::SparseRows P = wanted(K.rows());
  const MatrixXd exact = P * K.inverse() * MatrixXd(P).transpose();
  std::vector<int> loads{0, 1, 2, 5, 19, 20, 21, 28};
  for (int leaf : {kSmallLeaf, 100, 100'000}) {
    NestedResponse response(system.matrices.K, P, loads, {}, leaf);
    std::vector<int> asked = all_in(response);
    test::figure({"nested dissection, block", "responses"}, deviation_of(response, exact).largest, kSingle);
    std::sort(asked.begin(), asked.end());
    EXPECT_EQ(asked, loads);
  }
}

// R: as many independent fields as there are rigid motions, which need not be such for this algebra.
TEST(NestedResponse, balances_loads_on_free_bodies_by_inertia) {
  const test::System system = block();
  const MatrixXd K = dense(system.matrices.K), M = dense(system.matrices.M);
  const Eigen::Index n = K.rows();
  const InertiaRelief relief(system.matrices.M, MatrixXd::Random(n, 6));
  const RigidFields rigid = relief.fields();
  EXPECT_LE((M * rigid.R - rigid.M_R).norm(), kRoundoff * rigid.M_R.norm());
  const model::SparseRows P = wanted(n);
  const MatrixXd without = MatrixXd(P) - P * rigid.R * rigid.M_R.transpose(),
                 exact = without * K.inverse() * without.transpose();
  std::vector<int> loads(30);
  std::iota(loads.begin(), loads.end(), 0);
  for (int leaf : {kSmallLeaf, 100'000}) {
    NestedResponse response(system.matrices.K, P, loads, rigid, leaf);
    EXPECT_LE(deviation_of(response, exact).largest, kSingle) << leaf;
  }
}

// Loads on all of a slender body: many a column of every separator, whose columns then are ordered, and most
// of them far from it. Rows for stresses are of another size than displacements.
TEST(NestedResponse, leaves_out_nothing_that_single_precision_shows) {
  const test::System system = test::assemble(test::brick({3, 3, 40}, {1, 1, 13}), {"zmin"});
  const MatrixXd K = dense(system.matrices.K);
  const Eigen::Index n = K.rows();
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n; ++i) entries.emplace_back(i, i, 1.0);
  for (int i = 0; i + 48 < n; ++i)
    for (int k : {0, 3, 48}) entries.emplace_back(static_cast<int>(n) + i, i + k, k == 0 ? -3e11 : 1e11);
  model::SparseRows P(2 * n - 48, n);
  P.setFromTriplets(entries.begin(), entries.end());
  const MatrixXd exact = P * K.ldlt().solve(MatrixXd(P).transpose());
  std::vector<int> loads(static_cast<std::size_t>(n));
  std::iota(loads.begin(), loads.end(), 0);
  NestedResponse response(system.matrices.K, P, loads, {}, 200);
  EXPECT_GT(response.groups().size(), 1u);
  const Deviation error = deviation_of(response, exact);
  EXPECT_LE(error.rms, kUnitRoundoff / 2);
  EXPECT_LE(error.largest, kLargest);
}

// Far rows, which are long in few directions, need fewer columns than near ones, and what is left out is
// negligible.
TEST(NestedResponse, orders_the_columns_of_a_separator_by_what_rows_know_of_them) {
  const int n_rows = 800, n_columns = 128;
  srand(3);
  MatrixXd C = MatrixXd::Random(n_rows, n_columns);
  for (int i = 0; i < n_rows; ++i)
    for (int j = 0; j < n_columns; ++j) C(i, j) = i < 40 ? j == 2 * i + 48 : C(i, j) * std::pow(0.5, j);
  const Eigen::MatrixXd turn = MatrixXd::Random(n_columns, n_columns).householderQr().householderQ();
  C = (C * turn).eval();
  std::vector<int> rows(n_rows);
  std::iota(rows.begin(), rows.end(), 0);
  const Contribution<float> plain{.row = rows, .C = C.cast<float>()};
  const Eigen::VectorXd scale = row_scales(Contributions<float>{plain}, n_rows);
  const MatrixXd V = directions(C.transpose() * scale.cwiseAbs2().cwiseInverse().asDiagonal() * C);
  EXPECT_LE((V.transpose() * V - MatrixXd::Identity(n_columns, n_columns)).cwiseAbs().maxCoeff(), 1e-13);
  Contribution<float> ordered{.row = rows, .C = (C * V).cast<float>(), .is_ordered = true};
  order_rows(scale, ordered);
  ASSERT_EQ(ordered.left_out.rows(), n_rows);
  EXPECT_NEAR(ordered.left_out(0, 0), 1, 1e-5);
  EXPECT_LT(ordered.left_out(0, 2), 0.01F * ordered.left_out(n_rows - 1, 2));
  EXPECT_LE(ordered.left_out.rightCols<1>().maxCoeff(), 0);
  const std::vector<int> loads{0, 39, 40, 500};
  ASSERT_EQ(ordered.row.size(), plain.row.size());
  Eigen::MatrixXf Y = Eigen::MatrixXf::Zero(n_rows, 4), Y_plain = Y;
  std::vector<int> column(n_rows, -1);
  for (int j = 0; j < 4; ++j) column[loads[j]] = j;
  add_responses(ordered, column, Y);
  add_responses(plain, column, Y_plain);
  const MatrixXd exact = C * C(loads, Eigen::all).transpose();
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < n_rows; ++i) {
      const double size = C.row(i).norm() * C.row(loads[j]).norm();
      EXPECT_LE(std::abs(Y(i, j) - exact(i, j)), kSingle * size);
      EXPECT_LE(std::abs(Y_plain(i, j) - exact(i, j)), kSingle * size);
    }
}

// Between its first two eigenvalues the leaves, held all around, are definite and the body is not.
TEST(NestedResponse, refuses_what_is_not_positive_definite) {
  const test::System system = block();
  const MatrixXd K = dense(system.matrices.K), M = dense(system.matrices.M);
  const double lowest = Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(K, M).eigenvalues()[0];
  check(MatAXPY(system.matrices.K, -1.01 * lowest, system.matrices.M, SAME_NONZERO_PATTERN));
  for (int leaf : {kSmallLeaf, 100'000})
    EXPECT_THROW(NestedResponse(system.matrices.K, wanted(K.rows()), {0}, {}, leaf), Error) << leaf;
}

}  // namespace
}  // namespace elastogear::nested_response_test
