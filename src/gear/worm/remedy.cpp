#include "gear/worm/remedy.h"

#include <cmath>
#include <numbers>
#include <sstream>

#include "elastogear/base/error.h"

namespace elastogear::gear {
namespace {

struct Choice {
  const char* name;
  double Design::*value;
  double unit;  // of the message, in that of the design
  const char* unit_name;
};

constexpr Choice kChoices[] = {{"addendum", &Design::addendum, 1, "m"},
                               {"dedendum", &Design::dedendum, 1, "m"},
                               {"worm_fillet", &Design::worm_fillet, 1, "m"},
                               {"wheel_rack_tip", &Design::wheel_rack_tip, 1, "m"},
                               {"face_width", &Design::face_width, 1, "m"},
                               {"pressure_angle", &Design::alpha_n, std::numbers::pi / 180, "deg"}};

// Three digits, as on a drawing.
double rounded(double value) {
  const double step = std::pow(10, std::floor(std::log10(value)) - 2);
  return std::round(value / step) * step;
}

bool does(const Design& d, const std::function<void(const Design&)>& check) {
  try {
    check(d);
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

std::string nearest_that_does(const Design& d, const std::function<void(const Design&)>& check) {
  constexpr int kSteps = 70;      // to half and to twice the value
  constexpr double kStep = 1.01;  // of a value to the next one
  for (int i = 1; i <= kSteps; ++i)
    for (const Choice& choice : kChoices)
      for (int sign : {1, -1}) {
        Design other = d;
        const double value = rounded(d.*choice.value * std::pow(kStep, sign * i) / choice.unit);
        other.*choice.value = value * choice.unit;
        if (!does(other, check)) continue;
        std::ostringstream text;
        text << "; the nearest value that does, all others kept: " << choice.name << " = " << value << ' '
             << choice.unit_name;
        return text.str();
      }
  return "";
}

}  // namespace elastogear::gear
