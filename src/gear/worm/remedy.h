#pragma once
// The nearest value of a worm drive that cannot be made with which it can.

#include <functional>
#include <string>

#include "elastogear/gear/design.h"

namespace elastogear::gear {

/// "; the nearest value that does, all others kept: addendum = 0.00312 m": of the toothing's lengths and the
/// pressure angle the one that least changes, as a part of itself, the design to one that `check` accepts.
/// Empty where none does between half and twice itself. check: throws Error on designs that cannot be made.
std::string nearest_that_does(const Design& d, const std::function<void(const Design&)>& check);

}  // namespace elastogear::gear
