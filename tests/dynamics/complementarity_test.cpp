// Linear complementarity against all choices of closed contacts.
#include "dynamics/contact/complementarity.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

namespace elastogear::complementarity_test {
namespace {

using dynamics::solve_complementarity;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Tries every set of closed contacts.
VectorXd by_trial(const MatrixXd& C, const VectorXd& q) {
  const auto n = static_cast<int>(q.size());
  for (int set = 0; set < 1 << n; ++set) {
    std::vector<int> closed;
    for (int i = 0; i < n; ++i)
      if (set >> i & 1) closed.push_back(i);
    VectorXd p = VectorXd::Zero(n);
    if (!closed.empty()) p(closed) = MatrixXd(C(closed, closed)).inverse() * -q(closed);
    const double least = std::min(p.minCoeff(), (q + C * p).minCoeff());
    if (least > -1e-12) return p;
  }
  ADD_FAILURE() << "no solution";
  return {};
}

struct Problem {
  MatrixXd C;
  VectorXd q;
};

// unsymmetric: share of a part that friction would add.
Problem random_problem(int n, double unsymmetric) {
  const MatrixXd A = MatrixXd::Random(n, n), S = MatrixXd::Random(n, n);
  return {A * A.transpose() + 0.1 * MatrixXd::Identity(n, n) + unsymmetric * (S - S.transpose()),
          VectorXd::Random(n)};
}

TEST(Complementarity, is_solved_as_by_trial_of_all_sets) {
  std::srand(1);
  for (double unsymmetric : {0., 0.5})
    for (int n : {1, 2, 5, 8})
      for (int trial = 0; trial < 30; ++trial) {
        const Problem problem = random_problem(n, unsymmetric);
        for (bool guess : {false, true}) {
          const auto p = solve_complementarity(problem.C, problem.q,
                                               std::vector<bool>(static_cast<std::size_t>(n), guess));
          ASSERT_TRUE(p.has_value());
          EXPECT_LT((*p - by_trial(problem.C, problem.q)).norm(), 1e-9 * (1 + p->norm()));
        }
      }
}

TEST(Complementarity, of_many_contacts_holds_entry_by_entry) {
  std::srand(2);
  const Problem problem = random_problem(120, 0.3);
  const auto p = solve_complementarity(problem.C, problem.q, std::vector<bool>(120, true));
  ASSERT_TRUE(p.has_value());
  const VectorXd y = problem.q + problem.C * *p;
  EXPECT_GE(p->minCoeff(), 0);
  EXPECT_GT(y.minCoeff(), -1e-9);
  EXPECT_LT(p->cwiseProduct(y).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_GT((p->array() > 0).count(), 10);
}

TEST(Complementarity, without_contacts_has_no_forces) {
  const auto p = solve_complementarity(MatrixXd(0, 0), VectorXd(0), {});
  ASSERT_TRUE(p.has_value());
  EXPECT_EQ(p->size(), 0);
}

}  // namespace
}  // namespace elastogear::complementarity_test
