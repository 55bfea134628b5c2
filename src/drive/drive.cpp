#include "elastogear/drive/drive.h"

#include <Eigen/Geometry>

#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"

namespace elastogear::drive {
namespace {

using Eigen::Vector3d;

// The direction of the common perpendicular from the mate's axis to the member's own one.
Vector3d away_from_mate(const Drive& drive, int i) {
  for (const Pair& pair : drive.pairs) {
    if (pair.first != i && pair.second != i) continue;
    const auto own = static_cast<std::size_t>(i),
               mate = static_cast<std::size_t>(pair.first + pair.second - i);
    return (drive.members[own].position - drive.members[mate].position).normalized();
  }
  return Vector3d::UnitX();
}

void move(Member& member, const Vector3d& away, const Misalignment& by) {
  const Eigen::Matrix3d R = rotation_matrix(member.rotation);
  const Vector3d axis = R.col(2), tangential = axis.cross(away);
  const Eigen::Matrix3d tilt = rotation_matrix(Vector3d(by.inclination * tangential - by.skew * away));
  member.position += by.radial * away + by.tangential * tangential + by.axial * axis;
  member.angle += by.axial / member.toothing.p;  // as on a screw: its flanks stay where they meet the mate's
  const Eigen::AngleAxisd rotation(Eigen::Matrix3d(tilt * R));
  member.rotation = rotation.angle() * rotation.axis();
  for (double part : {by.radial, by.tangential, by.axial, by.inclination, by.skew})
    if (part != 0) member.misaligned = true;
}

}  // namespace

std::string pair_name(const Drive& drive, const Pair& pair) {
  return drive.members[static_cast<std::size_t>(pair.first)].name + ":" +
         drive.members[static_cast<std::size_t>(pair.second)].name;
}

void misalign(Drive& drive, const std::vector<Misalignment>& misalignment) {
  require(misalignment.size() == drive.members.size(), "there must be a misalignment of each of ",
          drive.members.size(), " members");
  std::vector<Vector3d> away;
  for (std::size_t i = 0; i < drive.members.size(); ++i)
    away.push_back(away_from_mate(drive, static_cast<int>(i)));
  for (std::size_t i = 0; i < drive.members.size(); ++i) move(drive.members[i], away[i], misalignment[i]);
}

}  // namespace elastogear::drive
