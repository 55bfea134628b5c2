#pragma once
// The finite elements that recovery asks for.

#include "elastogear/recovery/finite_elements.h"

namespace elastogear::app {

recovery::FiniteElements finite_elements();

}  // namespace elastogear::app
