#include "app/gear/bearing_options.h"

#include <cmath>

#include "app/input/column_table.h"
#include "app/options/rows.h"
#include "elastogear/base/error.h"

namespace elastogear::app {
namespace {

using drive::Bearing;

// Options of the stiffness that all bearings of a gear have together, at the origin of its body frame.
const Rows<Bearing> kBearingRows = {
    {"<gear>_bearing_radial", &Bearing::radial, "N/m",
     "drive: radial stiffness of the gear's bearings together; without it the axis is fixed",
     kDependent | kPositive},
    {"<gear>_bearing_axial", &Bearing::axial, "N/m",
     "drive: axial stiffness of the bearings (default: the radial one)", kDependent | kPositive},
    {"<gear>_bearing_tilt", &Bearing::tilt, "N m/rad",
     "drive: stiffness of the bearings against tilting (default: that of the radial one spread over the "
     "face)",
     kDependent | kPositive},
};

const Rows<Bearing> kOneBearingRows = {
    {"<gear>_bearings", "-", "", "drive: names of the gear's bearings; each has its own <bearing>_... keys"},
    {"bearing_catalogue", "-", "",
     "drive: CSV file of rolling bearings: a line for each, designation, radial and axial stiffness (N/m) "
     "and "
     "that against tilting (N m/rad)"},
    {"<bearing>_at", &Bearing::at, "m",
     "drive: place of the bearing along the gear's axis, from the middle of the teeth"},
    {"<bearing>_catalogue", "-", "", "drive: designation in bearing_catalogue whose stiffness it has"},
    {"<bearing>_radial", &Bearing::radial, "N/m", "drive: radial stiffness of the bearing", kDependent},
    {"<bearing>_axial", &Bearing::axial, "N/m",
     "drive: axial stiffness of the bearing (default: 0, or that of the catalogue)", kDependent},
    {"<bearing>_tilt", &Bearing::tilt, "N m/rad",
     "drive: stiffness of the bearing against tilting (default: 0, or that of the catalogue)", kDependent},
};

Bearing all_bearings(const Options& options, const DriveMember& member) {
  Bearing b{"bearing_of_" + member.name};
  read_rows(options, kBearingRows, b, member.name);
  if (b.axial == 0) b.axial = b.radial;
  if (b.tilt == 0) b.tilt = b.radial * member.width * member.width / 12;
  return b;
}

constexpr double kFarthest = 10;  // m, beyond any shaft: places farther off are given in a wrong unit

// The stiffness of a designation.
void take_from_catalogue(const std::string& file, const std::string& designation, Bearing& b) {
  ColumnTable table(file);
  bool found = false;
  while (table.next()) {
    if (table.text(0) != designation) continue;
    if (found) table.fail_here("the bearing '", designation, "' is there twice");
    if (table.n_columns() != 4)
      table.fail_here(
          "must be a designation, radial and axial stiffness (N/m) and that against tilting (N m/rad)");
    b.radial = table.number(1, "N/m");
    b.axial = table.number(2, "N/m");
    b.tilt = table.number(3, "N m/rad");
    found = true;
  }
  require(found, file, ": has no line of bearing '", designation, "'");
}

Bearing one_bearing(const Options& options, const std::string& name) {
  Bearing b{name};
  const std::string designation = name + "_catalogue";
  if (options.given(designation)) {
    require(options.given("bearing_catalogue"), options.label(designation), ": needs bearing_catalogue, too");
    take_from_catalogue(options.text("bearing_catalogue"), options.text(designation), b);
  }
  read_rows(options, kOneBearingRows, b, name);
  require(std::abs(b.at) <= kFarthest, options.label(name + "_at"), " = ", b.at, " m: must be within ",
          kFarthest, " m of the middle of the teeth; write its unit, as in '-20 mm'");
  return b;
}

}  // namespace

OptionTable bearing_table() { return table_of(kBearingRows, kOneBearingRows); }

std::vector<Bearing> bearings(const Options& options, const DriveMember& member) {
  const std::string radial = member.name + "_bearing_radial", list = member.name + "_bearings";
  for (const auto& row : kBearingRows) {
    const std::string name = with_word(row.spec.name, member.name);
    require(!options.given(name) || options.given(radial), options.label(name), ": needs ", radial, ", too");
  }
  require(!options.given(radial) || !options.given(list), options.label(radial), ": the gear has ", list,
          ", too; give one of the two");
  if (options.given(radial)) return {all_bearings(options, member)};
  std::vector<Bearing> all;
  if (!options.given(list)) return all;
  for (const std::string& name : options.list(list)) all.push_back(one_bearing(options, name));
  return all;
}

}  // namespace elastogear::app
