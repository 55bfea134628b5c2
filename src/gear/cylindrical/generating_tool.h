#pragma once

#include "elastogear/gear/cylindrical.h"
#include "gear/cylindrical/cutter.h"
#include "gear/rack.h"

namespace elastogear::gear {

/// The rack that generates an external gear i, of which pitch and root radius and tooth thickness are known.
RackTip generating_rack(const CylindricalDrive& drive, const CylindricalGeometry& geometry, int i);

/// The cutter that generates an internal gear i.
Cutter generating_cutter(const CylindricalDrive& drive, const CylindricalGeometry& geometry, int i);

/// The teeth of gear i, whose form radius is known, down to r_inner.
Profile tooth_profile(const CylindricalDrive& drive, const CylindricalGeometry& geometry, int i,
                      double r_inner);

}  // namespace elastogear::gear
