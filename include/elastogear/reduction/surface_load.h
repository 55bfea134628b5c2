#pragma once
// Unit loads on a contact surface, for the static completeness of a basis and for Krylov bases.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "elastogear/model/elastic_body.h"

namespace elastogear::reduction {

struct SurfaceLoad {
  std::string name;
  Eigen::VectorXd f;  ///< 3 n_s, N
};

/// Two loads for each representative group of the surface: unit normal pressure over the group ("<group>
/// pressure"), and a unit normal force on the node nearest to its centre ("<group> force"). Groups whose
/// names differ in digits only (tooth_01_left, tooth_02_left) count as alike: the first stands for all. At
/// most kMostGroups.
inline constexpr int kMostGroups = 8;
std::vector<SurfaceLoad> representative_loads(const model::Surface& surface);

/// Loads that vary slowly over each group, in columns of 3 n_s, N, or N m for the last kind: first the unit
/// pressure of all groups, then their unit tractions along x, y and z, then their pressures that grow along
/// x, y and z by 1 Pa/m from the group's centre. Only those first kinds (1, 4 or 7 columns a group) that make
/// at most `most` columns. Throws Error when there are more groups than that.
Eigen::MatrixXd smooth_loads(const model::Surface& surface, int most);

}  // namespace elastogear::reduction
