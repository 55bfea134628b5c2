#include "figures.h"

#include <gtest/gtest.h>

#include <cmath>

#include "figure_line.h"

namespace elastogear::test {
namespace {

std::string bound_text(const char* relation, double bound) {
  std::ostringstream text;
  text.precision(9);
  text << relation << " " << bound;
  return text.str();
}

}  // namespace

void figure(const Figure& figure, double value, double bound) {
  state_figure(figure.of, figure.quantity, figure.unit, value, bound_text("<", bound));
  EXPECT_LT(std::abs(value), bound) << figure.of << ": " << figure.quantity;
}

void figure_above(const Figure& figure, double value, double bound) {
  state_figure(figure.of, figure.quantity, figure.unit, value, bound_text(">", bound));
  EXPECT_GT(value, bound) << figure.of << ": " << figure.quantity;
}

}  // namespace elastogear::test
