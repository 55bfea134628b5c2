#include "elastogear/drive/drive.h"

namespace elastogear::drive {
namespace {

Member member(const gear::CylindricalDrive& design, const gear::CylindricalGeometry& geometry, int gear) {
  const auto i = static_cast<std::size_t>(gear);
  Member member;
  member.name = design.gears[i].name;
  member.toothing = geometry.gear[i];
  member.mesh = [=](const MeshDensity& by, mesh::ReadReport&) {
    const auto n = gear::cylindrical_counts(design, geometry, gear, by.size, by.order);
    return gear::cylindrical_mesh(design, geometry, gear, gear::refined(n, by.refinement));
  };
  member.held = member.toothing.internal ? "outer" : "bore";
  member.position.head<2>() = geometry.axis[i];
  member.width = geometry.blank[i].face_width;
  return member;
}

}  // namespace

Drive cylindrical_drive(const gear::CylindricalDrive& design, const gear::CylindricalGeometry& geometry,
                        const Start& start) {
  const auto angle = gear::angles(design, geometry, start.roll, !start.coasts);
  Drive drive;
  for (std::size_t i = 0; i < design.gears.size(); ++i) {
    drive.members.push_back(member(design, geometry, static_cast<int>(i)));
    drive.members.back().angle = angle[i];
  }
  for (const gear::GearPair& pair : design.pairs) {
    drive.pairs.push_back({pair.first, pair.second});
    const Member& first = drive.members[static_cast<std::size_t>(pair.first)];
    Member& second = drive.members[static_cast<std::size_t>(pair.second)];
    second.ratio =
        -first.toothing.sign() * second.toothing.sign() * first.ratio * first.toothing.z / second.toothing.z;
  }
  return drive;
}

}  // namespace elastogear::drive
