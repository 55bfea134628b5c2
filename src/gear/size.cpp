#include "elastogear/gear/size.h"

#include "elastogear/base/error.h"

namespace elastogear::gear {

Size size(const std::string& name) {
  if (name == "tiny") return Size::tiny;
  if (name == "small") return Size::small;
  if (name == "medium") return Size::medium;
  if (name == "paper") return Size::paper;
  fail("there is no mesh size '", name, "'; the sizes are tiny, small, medium, paper");
}

}  // namespace elastogear::gear
