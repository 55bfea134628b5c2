#include "elastogear/gear/size.h"

#include <algorithm>
#include <cmath>

#include "elastogear/base/error.h"

namespace elastogear::gear {

int refined(int count, double times) { return std::max(1, static_cast<int>(std::lround(count * times))); }

double refined_growth(double growth, double times) { return growth > 0 ? std::pow(growth, 1 / times) : 0; }

Size size(const std::string& name) {
  if (name == "tiny") return Size::tiny;
  if (name == "small") return Size::small;
  if (name == "medium") return Size::medium;
  if (name == "paper") return Size::paper;
  fail("there is no mesh size '", name, "'; the sizes are tiny, small, medium, paper");
}

}  // namespace elastogear::gear
