#include "app/gear/misalignment.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "app/options/rows.h"
#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"

namespace elastogear::app {
namespace {

using Eigen::Vector3d;

constexpr double kMostOffset = 0.1;  // of the tip radius
constexpr double kMostAngle = 2;     // deg

struct Misalignment {
  double radial = 0, tangential = 0, axial = 0;  // m
  double inclination = 0, skew = 0;              // deg
};

const Rows<Misalignment> kMisalignmentRows = {
    {"<gear>_radial_offset", &Misalignment::radial, "m", "drive: of the axis, away from the mate's"},
    {"<gear>_tangential_offset", &Misalignment::tangential, "m",
     "drive: of the axis, along the axis' direction x the direction away from the mate"},
    {"<gear>_axial_offset", &Misalignment::axial, "m", "drive: of the gear, along its axis"},
    {"<gear>_inclination", &Misalignment::inclination, "deg",
     "drive: of the axis in the plane of both axes, > 0: its +z end leans away from the mate"},
    {"<gear>_skew", &Misalignment::skew, "deg",
     "drive: of the axis out of that plane, the error of a shaft angle; > 0: its +z end leans along the "
     "axis' direction x the direction away from the mate"},
};

void check(const Options& options, const DriveMember& member, const Misalignment& m) {
  const double most = kMostOffset * member.toothing.r_a;
  const auto within = [&](const char* key, double value, double limit, const char* unit) {
    const std::string name = member.name + key;
    require(std::abs(value) <= limit, options.label(name), " = ", value, " ", unit, ": must be at most ",
            limit, " ", unit, " to either side; a larger one belongs to the design");
  };
  within("_radial_offset", m.radial, most, "m");
  within("_tangential_offset", m.tangential, most, "m");
  within("_axial_offset", m.axial, member.width, "m");
  within("_inclination", m.inclination, kMostAngle, "deg");
  within("_skew", m.skew, kMostAngle, "deg");
}

// The direction of the common perpendicular from the mate's axis to the member's own one.
Vector3d away_from_mate(const Drive& drive, int i) {
  for (const DrivePair& pair : drive.pairs) {
    if (pair.first != i && pair.second != i) continue;
    const DriveMember &own = drive.members[i], &mate = drive.members[pair.first + pair.second - i];
    return (own.position - mate.position).normalized();
  }
  return Vector3d::UnitX();
}

}  // namespace

OptionTable misalignment_table() { return table_of(kMisalignmentRows); }

void misalign(const Options& options, Drive& drive) {
  std::vector<Vector3d> away;
  for (std::size_t i = 0; i < drive.members.size(); ++i)
    away.push_back(away_from_mate(drive, static_cast<int>(i)));
  for (std::size_t i = 0; i < drive.members.size(); ++i) {
    DriveMember& member = drive.members[i];
    Misalignment m;
    read_rows(options, kMisalignmentRows, m, member.name);
    check(options, member, m);
    const Eigen::Matrix3d R = rotation_matrix(member.rotation);
    const Vector3d axis = R.col(2), tangential = axis.cross(away[i]);
    const double degree = std::numbers::pi / 180;
    const Eigen::Matrix3d tilt =
        rotation_matrix(Vector3d(degree * (m.inclination * tangential - m.skew * away[i])));
    member.position += m.radial * away[i] + m.tangential * tangential + m.axial * axis;
    member.angle += m.axial / member.toothing.p;  // as on a screw: its flanks stay where they meet the mate's
    const Eigen::AngleAxisd rotation(Eigen::Matrix3d(tilt * R));
    member.rotation = rotation.angle() * rotation.axis();
  }
}

}  // namespace elastogear::app
