// Figures of the table "Cases" in docs/validation/README.md. The bound that a test states is the one that it
// holds.
#pragma once

#include <string>

namespace elastogear::test {

// A quantity of a case, as the table names both. Values and bounds are in SI units; the unit is the table's,
// "%", "m" or "µm".
struct Figure {
  std::string of, quantity, unit = {};
};

// Expects |value| < bound.
void figure(const Figure& figure, double value, double bound);

// Expects value > bound.
void figure_above(const Figure& figure, double value, double bound);

}  // namespace elastogear::test
