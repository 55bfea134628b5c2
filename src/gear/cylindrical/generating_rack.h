#pragma once

#include "elastogear/gear/cylindrical.h"
#include "gear/rack.h"

namespace elastogear::gear {

/// The rack that generates gear i, of which pitch and root radius and tooth thickness are known.
RackTip generating_rack(const CylindricalDrive& drive, const CylindricalGeometry& geometry, int i);

}  // namespace elastogear::gear
