#pragma once
// Units that may stand behind a number: "3 mm", "20 deg", "210 GPa".

#include <string>

namespace elastogear::app {

/// The text with each number of a list that has a unit converted to `unit` ("m", "rad", "N m"), in 17 digits;
/// texts that do not begin with a number, and plain numbers, as they are. In lists that begin with a word,
/// "ramp,4 kN m,1 ms", numbers may measure different things: they are converted to SI units. Throws Error
/// that begins with `label` for units that are not known or measure something else. Where `unit` is none of
/// those known ("-"), nothing is done.
std::string in_unit(const std::string& label, const std::string& text, const std::string& unit);

/// The heading of a column.
struct Heading {
  std::string name, unit;  ///< "torque", "kN m"; the unit is empty where there is none, or 1
};

/// Of "torque [kN m]", "torque (kN m)", "torque / kN m", "torque, kN m" or "torque in kN m". Throws Error
/// that begins with `label` where parentheses hold no unit that is known.
Heading heading_of(const std::string& label, const std::string& text);

/// The units that in_unit knows for what `unit` measures, "um, mm, cm, m"; empty when it knows none.
std::string units_like(const std::string& unit);

}  // namespace elastogear::app
