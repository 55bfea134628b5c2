#pragma once
// Joints in minimal coordinates: how the body reference frame B moves in the world W.

#include <Eigen/Core>

namespace elastogear::body {

enum class JointType { fixed, revolute };

/// A joint between the world and a BRF; its axis passes through the BRF's origin.
struct Joint {
  JointType type = JointType::fixed;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();      ///< -, in the BRF, any length but zero
  Eigen::Vector3d r_WB0 = Eigen::Vector3d::Zero();      ///< m, BRF origin at s = 0
  Eigen::Matrix3d R_WB0 = Eigen::Matrix3d::Identity();  ///< body to world at s = 0
};

struct Placement {
  Eigen::Vector3d r_WB;  ///< m
  Eigen::Matrix3d R_WB;  ///< body to world
};

/// H, 6 x n_s: [v_WB_B; w_WB_B] = H s'. Constant in B; its columns commute as twists, which the equations of
/// motion rely on (true of every screw motion about one axis).
using MotionSubspace = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// H of a joint. Throws Error when the axis is zero or not finite.
MotionSubspace motion_subspace(const Joint& joint);

/// Placement exp(H s) relative to the joint's own: r = r_0 + R_0 H_v s, R = R_0 exp((H_w s)~).
Placement placement(const Joint& joint, const MotionSubspace& H, const Eigen::VectorXd& s);

}  // namespace elastogear::body
