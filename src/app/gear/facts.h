#pragma once
// Numbers of a drive's design, to be printed and for programs.

#include <string>
#include <vector>

#include "app/console/console.h"
#include "elastogear/base/text.h"

namespace elastogear::app {

/// A number in SI units; "1": without a unit.
struct Figure {
  std::string name;
  double value = 0;
  std::string unit = "1";
};

/// A line to be printed, with the numbers in it; none: it says something else.
struct Fact {
  std::string name, text;
  std::vector<Figure> figures = {};
};
using Facts = std::vector<Fact>;

/// "pitch / tip diameter", "51 mm / 57 mm".
inline Fact lengths(const std::string& name, const std::vector<Figure>& figures) {
  Fact fact{name, join(figures, " / ", [](const Figure& f) { return in_mm(f.value); }), figures};
  for (Figure& figure : fact.figures) figure.unit = "m";
  return fact;
}

}  // namespace elastogear::app
