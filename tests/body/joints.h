#pragma once
// Joints of every type, for tests of what holds for all of them.

#include <vector>

#include "elastogear/base/rotation.h"
#include "elastogear/body/joint.h"

namespace elastogear::test {

inline body::Joint joint_of(body::JointType type) {
  return {type, {1, 2, -2}, {0.3, 0.2, -0.1}, rotation_matrix({0.3, -0.2, 0.9}), {0.5, -0.4, 0.2}};
}

/// All types but the fixed one.
inline std::vector<body::JointType> moving_joints() {
  std::vector<body::JointType> types;
  for (std::size_t i = 1; i < body::joint_names().size(); ++i)
    types.push_back(static_cast<body::JointType>(i));
  return types;
}

}  // namespace elastogear::test
