#pragma once
// Numbers of a drive's design, as they stand in the table of a drawing.

#include <string>
#include <vector>

#include "elastogear/gear/cylindrical.h"
#include "elastogear/gear/design.h"

namespace elastogear::drive {

/// A number in units "m", "rad" or "1".
struct Figure {
  std::string name;
  double value = 0;
  std::string unit = "1";
  std::string suffix = {};  ///< what follows the number where it is shown, as " transverse"
};

/// A line of the table: figures that belong together, or, where there are none, a text.
struct Fact {
  std::string name;
  std::vector<Figure> figures = {};
  std::string text = {};
};
using Facts = std::vector<Fact>;

/// Those of each member and each pair of a drive, in their order.
struct DriveFacts {
  std::vector<Facts> members = {}, pairs = {};
};

/// geometry: of the design, by derive().
DriveFacts facts(const gear::CylindricalDrive& design, const gear::CylindricalGeometry& geometry);
DriveFacts facts(const gear::Design& design, const gear::Geometry& geometry);

/// The coefficient of friction from which on the wheel cannot drive its worm: the force that turns the worm
/// vanishes where mu = tan(gamma) cos(alpha_n), both angles at the pitch cylinders.
double locking_friction(const gear::Geometry& geometry);

}  // namespace elastogear::drive
