#pragma once
// Joints in minimal coordinates: how the body reference frame B moves in the world W.

#include <Eigen/Core>
#include <string>
#include <vector>

namespace elastogear::body {

/// Coordinates s and their rates:
/// revolute: angle (rad); prismatic: displacement (m); cylindrical: angle, then displacement;
/// spherical: a local rotation vector in B (rad) about `point`;
/// free: r_WB in W (m), then a local rotation vector.
/// Local rotation vectors are re-based to zero after every step: R_WB = R_WB0 cayley(psi). Their rates are
/// the angular velocity w_WB_B and its derivative, not psi' and psi''.
enum class JointType { fixed, revolute, prismatic, cylindrical, spherical, free };

/// A joint between the world and a BRF.
struct Joint {
  JointType type = JointType::fixed;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();      ///< -, in the BRF, any length but zero
  Eigen::Vector3d r_WB0 = Eigen::Vector3d::Zero();      ///< m, BRF origin at s = 0; free: not used
  Eigen::Matrix3d R_WB0 = Eigen::Matrix3d::Identity();  ///< body to world at s = 0
  Eigen::Vector3d point =
      Eigen::Vector3d::Zero();  ///< m, in the BRF, through which the axis passes; spherical: the centre
};

/// Number of coordinates, 0..6.
int coordinate_count(JointType type);
/// "fixed", "revolute", ...; in the order of JointType.
const std::vector<std::string>& joint_names();
bool has_rotation_axis(JointType type);     ///< has an angle about an axis
bool has_translation_axis(JointType type);  ///< has a displacement along an axis
bool has_rotation_vector(JointType type);   ///< its last three coordinates are a local rotation vector
/// Is coordinate i an angle, or one of a local rotation vector, in rad? Others are lengths.
bool is_angle(JointType type, Eigen::Index i);

struct Placement {
  Eigen::Vector3d r_WB;  ///< m
  Eigen::Matrix3d R_WB;  ///< body to world
};

Placement placement(const Joint& joint, const Eigen::VectorXd& s);

/// H, 6 x n_s, constant: the joint's virtual twists [v_WB_B; w_WB_B]. Generalised forces are conjugate to
/// them. All but the free joint: [v; w] = H s'. Free: the identity, and v = R_WB' r'.
using MotionSubspace = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// Throws Error when the axis is zero or not finite, or the point is not finite.
MotionSubspace motion_subspace(const Joint& joint);

/// Motion of the frame, components in B.
struct FrameMotion {
  Eigen::Vector3d v, w;        ///< m/s, rad/s
  Eigen::Vector3d a_s, alpha;  ///< m/s^2, rad/s^2: the part of a in proportion to s''; w'
  Eigen::Vector3d a_c;         ///< m/s^2, the rest of a = R_WB' r'': centripetal
  Eigen::Vector3d a() const { return a_s + a_c; }
};

/// Joint coordinates and their rates, n_s each.
struct JointMotion {
  const Eigen::VectorXd &s, &s_dot, &s_ddot;
};

FrameMotion frame_motion(const Joint& joint, const MotionSubspace& H, const JointMotion& m);

/// Change of the frame with s when s' and s'' change by shift_v and shift_a times as much; 3 x n_s each.
struct FrameDerivative {
  Eigen::Matrix3Xd r, theta;     ///< of the origin and the orientation, components in B
  Eigen::Matrix3Xd w, a, alpha;  ///< of w, a = R_WB' r'' and w'
};

struct Shifts {
  double v, a;  ///< 1/s, 1/s^2
};

FrameDerivative frame_derivative(const Joint& joint, const MotionSubspace& H, const JointMotion& m,
                                 const Shifts& shift);

/// The joint that has the same placement where its local rotation vector is zero. Joints without one stay as
/// they are.
Joint rebased(const Joint& joint, const Eigen::VectorXd& s);

}  // namespace elastogear::body
