// Responses by nested dissection beside those of dense inverses, with leaves so small that there are many
// separators.
#include "reduction/static_response/nested_response.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <numeric>
#include <set>

#include "../fem/system.h"
#include "elastogear/base/error.h"
#include "reduction/static_response/dissection.h"

namespace elastogear::nested_response_test {
namespace {

using namespace reduction;
using Eigen::MatrixXd;

constexpr double kRoundoff = 1e-9;  // relative, times the condition number
constexpr int kSmallLeaf = 30;      // rows

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
    const NestedResponse response(system.matrices.K, P, loads, {}, leaf);
    std::vector<int> asked = all_in(response);
    EXPECT_LE((response(asked) - exact(Eigen::all, asked)).norm(), kRoundoff * exact.norm()) << leaf;
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
    const NestedResponse response(system.matrices.K, P, loads, rigid, leaf);
    const std::vector<int> asked = all_in(response);
    EXPECT_LE((response(asked) - exact(Eigen::all, asked)).norm(), kRoundoff * exact.norm()) << leaf;
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
