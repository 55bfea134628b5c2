#include "recovery/mode_acceleration.h"

#include <gtest/gtest.h>

namespace elastogear::recovery::mode_acceleration_test {
namespace {

constexpr double kRoundoff = 1e-14;

TEST(DynamicPart, of_a_static_answer_is_zero) {
  model::ElasticBody body;
  const Eigen::MatrixXd Phi = Eigen::MatrixXd::Random(15, 4);
  body.surface.Phi = model::DenseRows(Phi);
  const Eigen::Vector4d stiffness(1, 4, 9, 30);
  body.K_r = Eigen::MatrixXd(stiffness.asDiagonal()).sparseView();
  const model::ForceHistory forces{{1, 4}, Eigen::MatrixXd::Random(6, 3)};
  Eigen::MatrixXd f = Eigen::MatrixXd::Zero(15, 3);
  f.middleRows(3, 3) = forces.force.topRows(3);
  f.middleRows(12, 3) = forces.force.bottomRows(3);
  const Eigen::MatrixXd q = stiffness.cwiseInverse().asDiagonal() * (Phi.transpose() * f);
  EXPECT_LT(dynamic_part(body, q, forces).norm(), 10 * kRoundoff * q.norm());
}

}  // namespace
}  // namespace elastogear::recovery::mode_acceleration_test
