#include <algorithm>

#include "drive/result_parts.h"
#include "elastogear/base/rotation.h"

namespace elastogear::drive {

// A gear's bearings stand in its file's order; their forces act on the gear, in the world.
std::vector<BearingOfRun> read_bearings(const DriveOfResults& of, const DriveResult& result) {
  std::vector<BearingOfRun> all;
  for (std::size_t i = 0; i < of.bearings.size(); ++i)
    for (const Bearing& bearing : of.bearings[i]) {
      const Member& member = of.drive.members.at(i);
      const std::string& name = bearing.name;
      const auto& known = result.header.bushings;
      if (std::find(known.begin(), known.end(), name) == known.end()) continue;
      const io::BushingHistory history = io::read_bushing_history(result.path, name);
      const Eigen::Vector3d axis = rotation_matrix(member.rotation).col(2);
      const auto across = [&](const Eigen::MatrixXd& of_all) -> Eigen::VectorXd {
        const Eigen::MatrixXd v = of_all(Eigen::all, result.steps);
        return (v - axis * (axis.transpose() * v)).colwise().norm().transpose();
      };
      const Eigen::MatrixXd u = history.displacement(Eigen::all, result.steps),
                            angle = history.angle(Eigen::all, result.steps);
      all.push_back({name, member.name, across(history.force),
                     -(axis.transpose() * history.force(Eigen::all, result.steps)).transpose(),
                     across(history.torque), u.topRows<2>().colwise().norm().transpose(),
                     u.row(2).transpose(), angle.topRows<2>().colwise().norm().transpose()});
    }
  return all;
}

}  // namespace elastogear::drive
