#pragma once
// Worm drives in proportion to their module.

#include <cmath>
#include <numbers>

#include "elastogear/gear/wheel.h"
#include "elastogear/gear/worm.h"

namespace elastogear::gear {

/// Module 2 mm, 20 degrees, 41 teeth, diameter quotient 10, a throated wheel.
inline Design worm_design(FlankForm form, int starts, WheelForm wheel = WheelForm::throated) {
  constexpr double kModule = 2e-3, kQuotient = 10;
  const double a = kModule / std::cos(std::atan(starts / kQuotient)) * (kQuotient + 41) / 2;
  Design d = proportioned(kModule, std::numbers::pi / 9, starts, 41, a);
  d.flank = form, d.wheel_form = wheel;
  d.face_width = 14e-3;
  return d;
}

}  // namespace elastogear::gear
