#include "app/gear/facts.h"

#include <algorithm>
#include <numbers>

#include "app/console/console.h"
#include "elastogear/base/text.h"

namespace elastogear::app {
namespace {

std::string text_of_figure(const drive::Figure& figure) {
  if (figure.unit == "m") return in_mm(figure.value) + figure.suffix;
  if (figure.unit == "rad") return with_unit(figure.value * 180 / std::numbers::pi, "deg") + figure.suffix;
  const std::string plain = with_unit(figure.value, "");
  return plain.substr(0, plain.find(' ')) + figure.suffix;
}

}  // namespace

std::string text(const drive::Fact& fact) {
  if (fact.figures.empty()) return fact.text;
  const bool differ = std::any_of(fact.figures.begin(), fact.figures.end(),
                                  [](const drive::Figure& figure) { return !figure.suffix.empty(); });
  return join(fact.figures, differ ? ", " : " / ", text_of_figure);
}

}  // namespace elastogear::app
