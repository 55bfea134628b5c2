#pragma once
// Rotation formulas (docs/theory, section 3.2). Rotation vectors in rad.

#include <Eigen/Core>

namespace elastogear {

/// Cross-product matrix: skew(a) b = a x b.
Eigen::Matrix3d skew(const Eigen::Vector3d& a);

/// Cross products a x of the columns, and of the columns with b: 3 x n.
Eigen::Matrix3Xd cross(const Eigen::Vector3d& a, const Eigen::Matrix3Xd& columns);
Eigen::Matrix3Xd cross(const Eigen::Matrix3Xd& columns, const Eigen::Vector3d& b);

/// Rotation matrix exp(skew(psi)) of a rotation vector (Rodrigues), Eq. (3.12).
Eigen::Matrix3d rotation_matrix(const Eigen::Vector3d& psi);

/// Cayley's rotation matrix (I - psi~/2)^-1 (I + psi~/2): angle 2 atan(|psi|/2), the rotation vector's to
/// second order. Regular for all psi; never reaches half a turn. Eq. (3.13).
Eigen::Matrix3d cayley(const Eigen::Vector3d& psi);

/// T in w = T(psi) psi' for R = cayley(psi), R' = R skew(w), Eq. (3.13).
Eigen::Matrix3d cayley_tangent(const Eigen::Vector3d& psi);

/// The nearest rotation matrix to one that has lost its orthogonality to roundoff (one Newton step of the
/// polar decomposition).
Eigen::Matrix3d orthonormalised(const Eigen::Matrix3d& R);

}  // namespace elastogear
