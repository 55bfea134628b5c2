#include "app/options/units.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <sstream>

#include "elastogear/base/error.h"

namespace elastogear::app {
namespace {

enum class Quantity {
  length,
  angle,
  time,
  mass,
  force,
  torque,
  pressure,
  speed,
  velocity,
  acceleration,
  frequency,
  density,
  stiffness,
  tilt,
  wear,
  temperature,
  molar_energy,
  share
};

struct Unit {
  const char* name;
  Quantity quantity;
  double si;        // this many SI units
  double zero = 0;  // the value 0, in SI units
};

using enum Quantity;
constexpr Unit kUnits[] = {{"nm", length, 1e-9},
                           {"um", length, 1e-6},
                           {"µm", length, 1e-6},
                           {"mm", length, 1e-3},
                           {"cm", length, 1e-2},
                           {"m", length, 1},
                           {"in", length, 25.4e-3},
                           {"deg", angle, std::numbers::pi / 180},
                           {"rad", angle, 1},
                           {"ns", time, 1e-9},
                           {"us", time, 1e-6},
                           {"µs", time, 1e-6},
                           {"ms", time, 1e-3},
                           {"s", time, 1},
                           {"min", time, 60},
                           {"h", time, 3600},
                           {"g", mass, 1e-3},
                           {"kg", mass, 1},
                           {"t", mass, 1e3},
                           {"N", force, 1},
                           {"kN", force, 1e3},
                           {"MN", force, 1e6},
                           {"N mm", torque, 1e-3},
                           {"N m", torque, 1},
                           {"Nm", torque, 1},
                           {"kN m", torque, 1e3},
                           {"kNm", torque, 1e3},
                           {"Pa", pressure, 1},
                           {"kPa", pressure, 1e3},
                           {"MPa", pressure, 1e6},
                           {"N/mm^2", pressure, 1e6},
                           {"GPa", pressure, 1e9},
                           {"kN/mm^2", pressure, 1e9},
                           {"rad/s", speed, 1},
                           {"rpm", speed, std::numbers::pi / 30},
                           {"1/min", speed, std::numbers::pi / 30},
                           {"m/s", velocity, 1},
                           {"mm/s", velocity, 1e-3},
                           {"m/s^2", acceleration, 1},
                           {"mm/s^2", acceleration, 1e-3},
                           {"Hz", frequency, 1},
                           {"kHz", frequency, 1e3},
                           {"kg/m^3", density, 1},
                           {"g/cm^3", density, 1e3},
                           {"t/mm^3", density, 1e12},
                           {"N/m", stiffness, 1},
                           {"N/mm", stiffness, 1e3},
                           {"N/um", stiffness, 1e6},
                           {"N/µm", stiffness, 1e6},
                           {"kN/mm", stiffness, 1e6},
                           {"N m/rad", tilt, 1},
                           {"kN m/rad", tilt, 1e3},
                           {"m^2/N", wear, 1},
                           {"mm^2/N", wear, 1e-6},
                           {"mm^3/(N m)", wear, 1e-9},
                           {"K", temperature, 1},
                           {"degC", temperature, 1, 273.15},
                           {"°C", temperature, 1, 273.15},
                           {"J/mol", molar_energy, 1},
                           {"kJ/mol", molar_energy, 1e3},
                           {"%", share, 1e-2}};

const Unit* find(const std::string& name) {
  const auto* unit =
      std::find_if(std::begin(kUnits), std::end(kUnits), [&](const Unit& u) { return name == u.name; });
  return unit == std::end(kUnits) ? nullptr : unit;
}

std::string trimmed_of(const std::string& text, const char* letters) {
  const auto first = text.find_first_not_of(letters), last = text.find_last_not_of(letters);
  return first == text.npos ? "" : text.substr(first, last - first + 1);
}

std::string trimmed(const std::string& text) { return trimmed_of(text, " []"); }

// A single number; the text itself where there is none, or no unit behind it. wanted: null: SI units.
std::string converted(const std::string& label, const std::string& text, const Unit* wanted) {
  const std::string word = trimmed(text);
  char* end = nullptr;
  const double value = std::strtod(word.c_str(), &end);
  const std::string name = trimmed(end);
  if (end == word.c_str() || name.empty()) return text;
  // "5.csv" and "5/a.csv" are files, "5 in/s" would be a number with a unit.
  const bool file = end[-1] == '.' || (*end != ' ' && name.find_first_of("./\\") != name.npos);
  if (file && !find(name)) return text;
  const Unit* unit = find(name);
  require(unit && (!wanted || unit->quantity == wanted->quantity), label, " = '", word, "': '", name,
          "' is no unit of it", wanted ? ", write " + units_like(wanted->name) : "");
  char number[32];
  const double si = value * unit->si + unit->zero;
  std::snprintf(number, sizeof number, "%.17g", wanted ? (si - wanted->zero) / wanted->si : si);
  return number;
}

std::string unit_or_none(const std::string& text) {
  std::string unit = trimmed(text);
  return unit == "1" || unit == "-" ? "" : unit;
}

// Name and unit of a heading like "speed m/s", "torque in kN m", "torque, kN m" or "torque / kN m"; nothing
// where it ends with no unit.
std::optional<Heading> behind_words(const std::string& heading) {
  const auto blank = heading.rfind(' '), slash = heading.rfind('/');
  if (blank != heading.npos && slash != heading.npos && slash > blank + 1 && find(heading.substr(blank + 1)))
    return Heading{trimmed_of(heading.substr(0, blank), " /,"), heading.substr(blank + 1)};
  for (const char* word : {" in ", ",", "/"}) {
    const auto at = heading.find(word);
    if (at == heading.npos || at == 0) continue;
    const std::string unit = trimmed(heading.substr(at + std::string(word).size())),
                      name = heading.substr(0, at);
    if (find(unit) && !find(heading)) return Heading{trimmed(name), unit};
  }
  return std::nullopt;
}

}  // namespace

std::string units_like(const std::string& unit) {
  const Unit* wanted = find(unit);
  std::string all;
  for (const Unit& other : kUnits)
    if (wanted && other.quantity == wanted->quantity &&
        std::isprint(static_cast<unsigned char>(other.name[0])))
      all += (all.empty() ? "" : ", ") + std::string(other.name);
  return all;
}

Heading heading_of(const std::string& label, const std::string& text) {
  std::string heading = trimmed_of(text, " \t\"");
  const auto open = heading.find('['), close = heading.find(']', open);
  if (open != heading.npos && close != heading.npos)
    return {trimmed(heading.substr(0, open)), unit_or_none(heading.substr(open + 1, close - open - 1))};
  if (const auto found = behind_words(heading)) return *found;
  if (!heading.ends_with(')')) return {heading, ""};
  std::string last;
  for (auto at = heading.find('('); at != heading.npos; at = heading.find('(', at + 1)) {
    if (at > 0 && heading[at - 1] == '/') continue;  // within a unit, "mm^3/(N m)"
    last = trimmed(heading.substr(at + 1, heading.size() - at - 2));
    if (const std::string unit = unit_or_none(last); unit.empty() || find(unit))
      return {trimmed(heading.substr(0, at)), unit};
  }
  fail(label, ": the heading '", heading, "' ends with '", last,
       "' in parentheses, which is no unit that is known: write the unit as in 'torque [kN m]', and other "
       "words without parentheses");
}

std::string in_unit(const std::string& label, const std::string& text, const std::string& unit) {
  const Unit* wanted = find(unit);
  if (!wanted) return text;
  const std::string first = trimmed(text.substr(0, text.find(',')));
  const bool led = !first.empty() && std::isalpha(static_cast<unsigned char>(first[0]));
  std::string all;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');)
    all += (all.empty() ? "" : ",") + converted(label, part, led ? nullptr : wanted);
  return all;
}

}  // namespace elastogear::app
