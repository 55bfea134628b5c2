#pragma once
// Stresses and static responses of unreduced bodies by their finite elements, for recovery.

#include "elastogear/recovery/finite_elements.h"

namespace elastogear::drive {

recovery::FiniteElements finite_elements();

}  // namespace elastogear::drive
