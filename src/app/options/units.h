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

/// "kN m" of the heading of a column, "torque [kN m]"; empty where it has none, or 1.
std::string unit_of_heading(const std::string& heading);

/// The units that in_unit knows for what `unit` measures, "um, mm, cm, m"; empty when it knows none.
std::string units_like(const std::string& unit);

}  // namespace elastogear::app
