// Block L D L' over the parts of a nested dissection: counts and solutions against MUMPS and dense matrices.
#include "reduction/eigensolver/nested_factor.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "../fem/system.h"
#include "elastogear/reduction/eigenmodes.h"
#include "reduction/dense/dense_inverse.h"

namespace elastogear::nested_factor_test {
namespace {

constexpr double kRoundoff = 1e-10;  // relative, of a solution, times the condition number
constexpr int kLeaf = 24;            // rows: many parts of a small matrix

test::System beam() { return test::assemble(test::brick({12, 3, 3}, {1, 0.2, 0.25}), {"xmin"}); }

Eigen::MatrixXd dense(Mat A) {
  PetscInt n = 0;
  check(MatGetSize(A, &n, nullptr));
  Eigen::MatrixXd D = Eigen::MatrixXd::Zero(n, n);
  for (PetscInt i = 0; i < n; ++i) {
    PetscInt width = 0;
    const PetscInt* column = nullptr;
    const PetscScalar* value = nullptr;
    check(MatGetRow(A, i, &width, &column, &value));
    for (PetscInt k = 0; k < width; ++k) D(i, column[k]) = value[k];
    check(MatRestoreRow(A, i, &width, &column, &value));
  }
  return D;
}

Eigen::VectorXd eigenvalues(const test::System& system) {
  const auto& [K, M] = system.matrices;
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(dense(K), dense(M)).eigenvalues();
}

// |A X - B| over |A| |X|.
double error_of(const Eigen::MatrixXd& A, const Eigen::MatrixXd& X, const Eigen::MatrixXd& B) {
  return (A * X - B).norm() / (A.norm() * X.norm());
}

TEST(NestedFactor, counts_eigenvalues_and_solves_at_any_shift) {
  const test::System system = beam();
  const auto& [K, M] = system.matrices;
  const Eigen::VectorXd lambda = eigenvalues(system);
  reduction::NestedFactor factor(K, M, kLeaf);
  const Eigen::MatrixXd B = Eigen::MatrixXd::Random(lambda.size(), 5);
  for (int below : {0, 3, 40, 200}) {
    const double sigma = below == 0 ? 0 : (lambda(below - 1) + lambda(below)) / 2;
    EXPECT_EQ(factor.count(sigma), below);
    EXPECT_EQ(factor.factorise(sigma), below);
    EXPECT_FALSE(factor.by_mumps());
    Eigen::MatrixXd X = B;
    factor.solve(X);
    EXPECT_LT(error_of(dense(K) - sigma * dense(M), X, B), kRoundoff) << below;
  }
}

TEST(NestedFactor, of_one_part_is_dense) {
  const test::System system = beam();
  const auto& [K, M] = system.matrices;
  const Eigen::MatrixXd B = Eigen::MatrixXd::Random(dense(K).rows(), 3);
  reduction::NestedFactor one(K, M, static_cast<int>(B.rows())), many(K, M, kLeaf);
  Eigen::MatrixXd X = B, Y = B;
  one.factorise(0);
  many.factorise(0);
  one.solve(X);
  many.solve(Y);
  EXPECT_LT((X - Y).norm(), kRoundoff * X.norm());
}

// An eigenvalue of the first part when all else is held: at this shift the part has no inverse, although the
// whole has one.
double eigenvalue_of_a_part(const test::System& system) {
  const auto& [K, M] = system.matrices;
  const Eigen::MatrixXd D_K = dense(K), D_M = dense(M);
  const reduction::EliminationTree tree =
      reduction::make_tree(K, Eigen::SparseMatrix<double>(0, D_K.rows()), kLeaf, {});
  const std::vector<int> rows(tree.at.begin(), tree.at.begin() + tree.part.front().n_rows());
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(D_K(rows, rows), D_M(rows, rows))
      .eigenvalues()(1);
}

TEST(NestedFactor, leaves_a_shift_at_an_eigenvalue_of_a_part_to_mumps) {
  const test::System system = beam();
  const auto& [K, M] = system.matrices;
  reduction::NestedFactor factor(K, M, kLeaf);
  const double sigma = eigenvalue_of_a_part(system);
  const int below = factor.factorise(sigma);
  EXPECT_TRUE(factor.by_mumps());
  EXPECT_EQ(below, reduction::count_eigenvalues_below(K, M, sigma));
  const Eigen::MatrixXd B = Eigen::MatrixXd::Random(dense(K).rows(), 2);
  Eigen::MatrixXd X = B;
  factor.solve(X);
  EXPECT_LT(error_of(dense(K) - sigma * dense(M), X, B), kRoundoff);
}

TEST(DenseInverse, of_a_singular_matrix_is_none) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Ones(3, 3);
  EXPECT_LT(reduction::invert_symmetric(A).condition, 1e-15);
}

TEST(DenseInverse, tells_the_signs_of_eigenvalues) {
  Eigen::MatrixXd A(3, 3);
  A << 0, 2, 0, 2, 0, 0, 0, 0, -3;
  Eigen::MatrixXd inverse = A;
  EXPECT_EQ(reduction::invert_symmetric(inverse).n_negative, 2);
  EXPECT_LT((A * inverse - Eigen::Matrix3d::Identity()).norm(), kRoundoff);
}

}  // namespace
}  // namespace elastogear::nested_factor_test
