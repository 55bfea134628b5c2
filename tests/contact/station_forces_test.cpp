// Forces of stations: least potential among all sets of stations, complementarity, tangent.

#include "elastogear/contact/station_forces.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>
#include <vector>

#include "elastogear/base/error.h"

namespace elastogear::contact::station_forces_test {
namespace {

constexpr double kCompliance = 2.8e-12;  // 1/Pa

// Symmetric positive definite compliances of the size of a gear's, gaps of both signs.
StationProblem random_problem(int n, std::mt19937& random) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> even(0.5, 2);
  const Eigen::MatrixXd A = Eigen::MatrixXd::NullaryExpr(n, n, [&] { return normal(random); });
  StationProblem problem;
  problem.C = 1e-9 * (A * A.transpose() / n + 0.1 * Eigen::MatrixXd::Identity(n, n));
  problem.gap = Eigen::VectorXd::NullaryExpr(n, [&] { return 5e-6 * (normal(random) - 0.3); });
  for (int i = 0; i < n; ++i)
    problem.own.push_back({2e-3 * even(random), 10e-3 * even(random), kCompliance, 0.4e-3});
  return problem;
}

// The forces of these stations where their gaps are closed, whatever their sign, by Newton's method from a
// large force; NaN where one becomes negative on the way.
Eigen::VectorXd closed(const StationProblem& problem, const std::vector<int>& stations) {
  Eigen::VectorXd f = Eigen::VectorXd::Zero(problem.gap.size());
  if (stations.empty()) return f;
  for (int i : stations) f[i] = 1000;
  for (int iteration = 0; iteration < 400; ++iteration) {
    Eigen::MatrixXd M = problem.C(stations, stations);
    for (Eigen::Index a = 0; a < M.rows(); ++a)
      M(a, a) += problem.own[static_cast<std::size_t>(stations[static_cast<std::size_t>(a)])].secant(
          f[stations[static_cast<std::size_t>(a)]]);
    const Eigen::VectorXd gap = problem.gap(stations);
    const Eigen::VectorXd next = M.ldlt().solve(-gap);
    for (std::size_t a = 0; a < stations.size(); ++a)
      f[stations[a]] = std::max(next[static_cast<Eigen::Index>(a)], 1e-12);
  }
  return f;
}

// The least potential of all sets of stations.
Eigen::VectorXd by_all_sets(const StationProblem& problem) {
  const int n = static_cast<int>(problem.gap.size());
  Eigen::VectorXd best = Eigen::VectorXd::Zero(n);
  for (int set = 1; set < 1 << n; ++set) {
    std::vector<int> stations;
    for (int i = 0; i < n; ++i)
      if (set >> i & 1) stations.push_back(i);
    const Eigen::VectorXd f = closed(problem, stations);
    if (potential(problem, f) < potential(problem, best)) best = f;
  }
  return best;
}

TEST(StationForces, are_those_of_the_best_set_of_stations) {
  std::mt19937 random(1);
  for (int repeat = 0; repeat < 40; ++repeat) {
    const StationProblem problem = random_problem(1 + repeat % 6, random);
    const Eigen::VectorXd expected = by_all_sets(problem), f = station_forces(problem).f;
    EXPECT_LT((f - expected).lpNorm<Eigen::Infinity>(), 1e-7 * (1 + expected.maxCoeff()));
  }
}

TEST(StationForces, press_where_gaps_are_closed) {
  std::mt19937 random(2);
  int most = 0;
  for (int repeat = 0; repeat < 300; ++repeat) {
    StationProblem problem = random_problem(1 + repeat % 60, random);
    problem.gap *= std::pow(10., repeat % 7 - 4);
    const StationForces forces = station_forces(problem);
    const Eigen::VectorXd gap = loaded_gaps(problem, forces.f);
    const double roundoff = 1e-9 * problem.gap.lpNorm<Eigen::Infinity>();
    EXPECT_GE(forces.f.minCoeff(), 0);
    EXPECT_GE(gap.minCoeff(), -roundoff);
    for (int i : forces.active) EXPECT_NEAR(gap[i], 0, roundoff);
    EXPECT_EQ(std::ssize(forces.active), (forces.f.array() > 0).count());
    EXPECT_EQ(forces.potential, potential(problem, forces.f));
    most = std::max(most, forces.iterations);
  }
  EXPECT_LE(most, 20);
}

TEST(StationForces, are_the_gradient_of_the_potential_and_have_the_tangent_that_they_say) {
  std::mt19937 random(3);
  StationProblem problem = random_problem(20, random);
  const StationForces forces = station_forces(problem);
  const Eigen::MatrixXd& K = forces.stiffness;
  const auto n = std::ssize(forces.active);
  ASSERT_GT(n, 3);
  ASSERT_LT(n, 20);
  ASSERT_EQ(K.rows(), n);
  EXPECT_EQ(K, K.transpose());
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K).eigenvalues().minCoeff(), 0);
  const double h = 1e-10;
  for (Eigen::Index a = 0; a < n; ++a) {
    const int i = forces.active[static_cast<std::size_t>(a)];
    StationProblem closer = problem, farther = problem;
    closer.gap[i] -= h;
    farther.gap[i] += h;
    const StationForces more = station_forces(closer), less = station_forces(farther);
    EXPECT_NEAR((less.potential - more.potential) / (2 * h), forces.f[i], 1e-4 * forces.f.maxCoeff());
    const Eigen::VectorXd change = (more.f - less.f) / (2 * h);
    EXPECT_LT((change(forces.active) - K.col(a)).norm(), 1e-4 * K.col(a).norm());
  }
}

TEST(StationForces, are_zero_without_overlap) {
  std::mt19937 random(4);
  StationProblem problem = random_problem(5, random);
  problem.gap.setConstant(1e-9);
  const StationForces forces = station_forces(problem);
  EXPECT_TRUE(forces.f.isZero(0));
  EXPECT_TRUE(forces.active.empty());
  EXPECT_EQ(forces.potential, 0);
  EXPECT_EQ(forces.stiffness.size(), 0);
}

// A drive turns until its forces balance the load: Newton's method by the tangent alone.
TEST(StationForces, balance_a_load_by_their_tangent) {
  std::mt19937 random(6);
  for (double load : {0.1, 100., 1e5}) {
    StationProblem problem = random_problem(24, random);
    const Eigen::VectorXd gap = problem.gap;
    double closing = 0;
    int steps = 0;
    for (double missing = load; std::abs(missing) > 1e-9 * load; ++steps) {
      ASSERT_LT(steps, 60);
      problem.gap = gap.array() - closing;
      const StationForces forces = station_forces(problem);
      missing = load - forces.f.sum();
      closing += forces.active.empty() ? 1e-7 - closing + gap.minCoeff() : missing / forces.stiffness.sum();
    }
    EXPECT_LT(steps, 20) << load;
  }
}

TEST(StationForces, refuse_gaps_that_are_no_numbers) {
  std::mt19937 random(8);
  StationProblem problem = random_problem(3, random);
  problem.gap[1] = std::nan("");
  EXPECT_THROW(station_forces(problem), Error);
}

TEST(StationForces, refuse_what_is_not_convex) {
  std::mt19937 random(5);
  StationProblem problem = random_problem(3, random);
  problem.gap.setConstant(-1e-6);
  problem.C = -1e-6 * Eigen::MatrixXd::Identity(3, 3);
  EXPECT_THROW(station_forces(problem), Error);
  problem.own.pop_back();
  EXPECT_THROW(station_forces(problem), Error);
}

}  // namespace
}  // namespace elastogear::contact::station_forces_test
