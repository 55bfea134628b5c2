#include "elastogear/life/revolution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "../message_of.h"
#include "elastogear/base/rotation.h"

namespace elastogear::life::revolution_test {
namespace {

constexpr double pi = std::numbers::pi;

// Three places of each of z teeth, in an order that tells nothing.
Eigen::Matrix3Xd nodes(int z) {
  const Eigen::Vector3d places[] = {{1, 0.1, 0}, {1, -0.1, 0.5}, {0.9, 0.1, 0}};
  Eigen::Matrix3Xd X(3, 3 * z);
  for (int i = 0; i < 3 * z; ++i) {
    const int shuffled = i * 13 % (3 * z);
    const int tooth = shuffled / 3;
    X.col(i) = rotation_matrix({0, 0, 2 * pi * tooth / z}) * places[shuffled % 3];
  }
  return X;
}

// What a node bears: a wave that stands still in the world, of a gear that turned by `roll` pitches. The
// second places of the teeth bear less.
double bearing(const Eigen::Vector3d& x, double roll, int z, int sense) {
  const double angle = std::atan2(x[1], x[0]) + sense * 2 * pi * roll / z;
  return std::exp(3 * std::cos(angle)) * (x[2] > 0 ? 0.5 : 1) * x.head<2>().norm();
}

Eigen::MatrixXd swept(const Eigen::Matrix3Xd& X, double pitches, int n, int z, int sense) {
  Eigen::MatrixXd stress(X.cols(), n);
  for (int i = 0; i < X.cols(); ++i)
    for (int k = 0; k < n; ++k) stress(i, k) = bearing(X.col(i), pitches * k / n, z, sense);
  return stress;
}

TEST(Revolutions, of_one_pitch_are_those_of_a_sweep_over_all_pitches) {
  for (int z : {1, 2, 11})
    for (int sense : {1, -1}) {
      const Eigen::Matrix3Xd X = nodes(z);
      const auto r = over_revolutions("root", swept(X, 1, 4, z, sense), X, {1, 4}, z, sense);
      const Eigen::MatrixXd all = swept(X, z, 4 * z, z, sense);
      ASSERT_EQ(r.node.size(), 3U);
      ASSERT_EQ(r.stress.rows(), 4 * z);
      for (int i = 0; i < 3; ++i)
        EXPECT_LT((r.stress.col(i) - all.row(r.node[i]).transpose()).norm(), 1e-12 * all.norm());
    }
}

TEST(Revolutions, of_whole_ones_are_taken_as_they_are) {
  const Eigen::Matrix3Xd X = nodes(5);
  const Eigen::MatrixXd stress = swept(X, 10, 20, 5, 1);
  const auto r = over_revolutions("root", stress, X, {10, 2}, 5, 1);
  EXPECT_FALSE(r.laid);
  EXPECT_EQ(r.count, 2);
  EXPECT_EQ(r.stress, stress.transpose());
}

TEST(Revolutions, tell_how_far_teeth_differ) {
  const Eigen::Matrix3Xd X = nodes(7);
  Eigen::MatrixXd stress = swept(X, 3, 12, 7, -1);
  EXPECT_LT(over_revolutions("root", stress, X, {3, 4}, 7, -1).difference, 1e-12);
  stress.rightCols(4).array() += 2;
  EXPECT_NEAR(over_revolutions("root", stress, X, {3, 4}, 7, -1).difference, 2, 1e-12);
  EXPECT_GT(over_revolutions("root", swept(X, 3, 12, 7, 1), X, {3, 4}, 7, -1).difference, 0.1);
}

TEST(Revolutions, refuse_nodes_that_do_not_repeat) {
  Eigen::Matrix3Xd X = nodes(7);
  X.col(4) *= 1.001;
  const std::string message = test::message_of([&] {
    over_revolutions("wheel root", swept(X, 1, 4, 7, 1), X, {1, 4}, 7, 1);
  });
  EXPECT_NE(message.find("wheel root: no node of its own lies within"), std::string::npos) << message;
}

TEST(Sweep, is_found_from_its_positions) {
  const auto positions = [](double from, double step, int n) {
    return Eigen::VectorXd(Eigen::VectorXd::LinSpaced(n, from, from + step * (n - 1)));
  };
  const Sweep one = find_sweep("a.h5", positions(0.3, 0.125, 8));
  EXPECT_EQ(one.pitches, 1);
  EXPECT_EQ(one.per_pitch, 8);
  const Sweep many = find_sweep("a.h5", positions(0, 0.25, 164));
  EXPECT_EQ(many.pitches, 41);
  EXPECT_EQ(many.per_pitch, 4);
  for (const auto& [roll, what] :
       {std::pair{positions(0, 1, 1), "has 1 position"}, std::pair{positions(0, 0.1, 8), "0.8 pitches"},
        std::pair{positions(0, 0.4, 5), "as many in each"}})
    EXPECT_NE(test::message_of([&roll = roll] { find_sweep("a.h5", roll); }).find(what), std::string::npos)
        << what;
  Eigen::VectorXd uneven = positions(0, 0.125, 8);
  uneven[3] += 0.01;
  EXPECT_NE(test::message_of([&] { find_sweep("a.h5", uneven); }).find("position 3"), std::string::npos);
}

TEST(SignedPrincipal, is_the_principal_stress_of_largest_size) {
  const Eigen::Matrix3d R = rotation_matrix({0.3, -1.1, 0.7});
  Eigen::MatrixXd stress(12, 1);
  const Eigen::Vector3d principal[] = {{5, -2, -9}, {9, -2, -5}};
  for (int i = 0; i < 2; ++i) {
    const Eigen::Matrix3d T = R * principal[i].asDiagonal() * R.transpose();
    stress.block<6, 1>(6 * i, 0) << T(0, 0), T(1, 1), T(2, 2), T(0, 1), T(1, 2), T(0, 2);
  }
  const Eigen::MatrixXd found = signed_principal(stress);
  EXPECT_NEAR(found(0, 0), -9, 1e-13);
  EXPECT_NEAR(found(1, 0), 9, 1e-13);
}

}  // namespace
}  // namespace elastogear::life::revolution_test
