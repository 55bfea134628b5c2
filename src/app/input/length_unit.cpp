#include "app/input/length_unit.h"

#include "elastogear/base/error.h"

namespace elastogear::app {
namespace {

double unit_of_option(const Options& options, const std::string& name) {
  constexpr double kLengths[] = {1, 1e-3, 1e-6, 25.4e-3};
  return kLengths[options.choice(name, {"m", "mm", "um", "in"})];
}

}  // namespace

double unit_in_m(const Options& options) { return unit_of_option(options, "unit"); }

double unit_in_m(const Options& options, const std::string& gear) {
  for (const std::string& name : {gear + "_unit", std::string("unit")})
    if (options.given(name)) return unit_of_option(options, name);
  return 1;
}

void require_consistent_unit(const Options& options, const std::string& what) {
  const std::string unit = options.text("unit");
  require(unit == "m" || unit == "mm", options.label("unit"), " = '", unit, "': ", what,
          " go with lengths in m or mm, in N and s; with others nobody knows their unit");
}

}  // namespace elastogear::app
