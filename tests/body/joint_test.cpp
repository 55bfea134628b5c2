// Where joints put a body, and how fast.
#include "elastogear/body/joint.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"
#include "joints.h"

namespace elastogear::joint_test {
using body::Joint;
using body::JointType;
using Eigen::Vector3d;
using Eigen::VectorXd;
using test::joint_of;

namespace {

constexpr double kRoundoff = 1e-13, kStep = 1e-5, kDifference = 1e-9;

struct Moving : testing::TestWithParam<JointType> {};
INSTANTIATE_TEST_SUITE_P(Joints, Moving, testing::ValuesIn(test::moving_joints()), [](const auto& info) {
  return body::joint_names()[static_cast<std::size_t>(info.param)];
});

// v, w and a from differences of the placement.
TEST_P(Moving, velocity_and_acceleration_are_the_rates_of_the_placement) {
  const Joint joint = joint_of(GetParam());
  const int n = body::coordinate_count(GetParam());
  std::srand(1);
  VectorXd s = VectorXd::Random(n), s_dot = VectorXd::Random(n), s_ddot = VectorXd::Random(n);
  if (has_rotation_vector(GetParam())) s.tail<3>().setZero();  // where psi' and psi'' are w and w'
  const auto H = body::motion_subspace(joint);
  const body::FrameMotion f = body::frame_motion(joint, H, {s, s_dot, s_ddot});
  const auto at = [&](double h) { return placement(joint, s + h * s_dot + h * h / 2 * s_ddot); };
  const auto now = at(0), next = at(kStep), before = at(-kStep);
  const Eigen::Matrix3d R_BW = now.R_WB.transpose();
  const Vector3d v = R_BW * (next.r_WB - before.r_WB) / (2 * kStep);
  const Eigen::Matrix3d W = R_BW * (next.R_WB - before.R_WB) / (2 * kStep);
  const Vector3d a = R_BW * (next.r_WB - 2 * now.r_WB + before.r_WB) / (kStep * kStep);
  constexpr double kTwiceDifferenced = 1e-4;
  EXPECT_LT((f.v - v).norm(), kDifference);
  EXPECT_LT((skew(f.w) - W).norm(), kDifference);
  EXPECT_LT((f.a() - a).norm(), kTwiceDifferenced);
}

TEST_P(Moving, twists_of_the_coordinates_are_the_changes_of_the_placement) {
  const Joint joint = joint_of(GetParam());
  const int n = body::coordinate_count(GetParam());
  std::srand(1);
  const VectorXd s = VectorXd::Random(n), zero = VectorXd::Zero(n);
  const auto d = body::frame_derivative(joint, body::motion_subspace(joint), {s, zero, zero}, {0, 0});
  const Eigen::Matrix3d R_BW = placement(joint, s).R_WB.transpose();
  for (int i = 0; i < n; ++i) {
    const VectorXd ds = kStep * VectorXd::Unit(n, i);
    const auto next = placement(joint, s + ds), before = placement(joint, s - ds);
    const Vector3d r = R_BW * (next.r_WB - before.r_WB) / (2 * kStep);
    const Eigen::Matrix3d theta = R_BW * (next.R_WB - before.R_WB) / (2 * kStep);
    EXPECT_LT((d.r.col(i) - r).norm(), kDifference);
    EXPECT_LT((skew(d.theta.col(i)) - theta).norm(), kDifference);
  }
}

TEST_P(Moving, angles_are_the_coordinates_that_turn_it) {
  const auto H = body::motion_subspace(joint_of(GetParam()));
  for (Eigen::Index i = 0; i < H.cols(); ++i)
    EXPECT_EQ(body::is_angle(GetParam(), i), !H.col(i).tail<3>().isZero(0)) << i;
}

TEST(Revolute, leaves_the_points_of_its_axis_where_they_are) {
  const Joint joint = joint_of(JointType::revolute);
  const auto at = [&](double angle, const Vector3d& X) -> Vector3d {
    const auto [r_WB, R_WB] = placement(joint, VectorXd::Constant(1, angle));
    return r_WB + R_WB * X;
  };
  for (double along : {0.0, 2.0}) {
    const Vector3d X = joint.point + along * joint.axis;
    EXPECT_LT((at(1.7, X) - at(0, X)).norm(), kRoundoff);
  }
  EXPECT_GT((at(1.7, Vector3d::Zero()) - at(0, Vector3d::Zero())).norm(), 0.1);
}

TEST(Cylindrical, turns_and_slides_along_one_axis) {
  const Joint joint{JointType::cylindrical, {0, 0, 2}, {1, 2, 3}};
  const auto [r_WB, R_WB] = placement(joint, Eigen::Vector2d(0.5, 4));
  EXPECT_LT((r_WB - Vector3d(1, 2, 7)).norm(), kRoundoff);
  EXPECT_LT((R_WB - rotation_matrix({0, 0, 0.5})).norm(), kRoundoff);
}

TEST(LocalRotationVector, is_emptied_without_a_change_of_the_placement) {
  for (JointType type : {JointType::spherical, JointType::free}) {
    const Joint joint = joint_of(type);
    VectorXd s = VectorXd::LinSpaced(body::coordinate_count(type), 0.3, -0.6);
    const auto before = placement(joint, s);
    const Joint next = rebased(joint, s);
    s.tail<3>().setZero();
    const auto after = placement(next, s);
    EXPECT_LT((before.r_WB - after.r_WB).norm(), kRoundoff);
    EXPECT_LT((before.R_WB - after.R_WB).norm(), kRoundoff);
  }
}

TEST(Joint, refuses_an_axis_without_direction_and_a_point_that_is_nowhere) {
  for (JointType type : {JointType::revolute, JointType::prismatic, JointType::cylindrical}) {
    EXPECT_THROW(body::motion_subspace({type, {0, 0, 0}}), Error);
    EXPECT_THROW(body::motion_subspace({type, {0, NAN, 1}}), Error);
    Joint joint{type};
    joint.point.x() = NAN;
    EXPECT_THROW(body::motion_subspace(joint), Error);
  }
}

}  // namespace
}  // namespace elastogear::joint_test
