#pragma once
// Rotation formulas (docs/theory.md, section Rotations). Rotation vectors in rad.

#include <Eigen/Core>

namespace elastogear {

/// Cross-product matrix: skew(a) b = a x b.
Eigen::Matrix3d skew(const Eigen::Vector3d& a);

/// Rotation matrix exp(skew(psi)) of a rotation vector (Rodrigues).
Eigen::Matrix3d rotation_matrix(const Eigen::Vector3d& psi);

}  // namespace elastogear
