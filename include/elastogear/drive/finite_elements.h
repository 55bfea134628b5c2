#pragma once
// What recovery asks of the finite elements of a whole body.

#include "elastogear/recovery/finite_elements.h"

namespace elastogear::drive {

recovery::FiniteElements finite_elements();

}  // namespace elastogear::drive
