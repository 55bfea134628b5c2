#include "app/gear/misalignment.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "app/options/rows.h"
#include "elastogear/base/error.h"

namespace elastogear::app {
namespace {

using drive::Misalignment;

constexpr double kMostOffset = 0.1;  // of the tip radius
constexpr double kMostAngle = 2;     // deg

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

}  // namespace

OptionTable misalignment_table() { return table_of(kMisalignmentRows); }

void misalign(const Options& options, Drive& drive) {
  constexpr double kDegree = std::numbers::pi / 180;  // rad
  std::vector<Misalignment> all;
  for (const DriveMember& member : drive.members) {
    Misalignment m;
    read_rows(options, kMisalignmentRows, m, member.name);
    check(options, member, m);
    m.inclination *= kDegree;
    m.skew *= kDegree;
    all.push_back(m);
  }
  drive::misalign(drive, all);
}

}  // namespace elastogear::app
