#pragma once
// Lengths that strips and points of contact measure by the height of a flank.

#include "elastogear/contact/exact_flanks.h"

namespace elastogear::contact {

inline constexpr double kReach = 0.05;  // of a flank's height: a gap that forces may close
inline constexpr double kDeepest =
    0.25;  // of a flank's height: a larger overlap is one with the tooth behind
inline constexpr double kWidth =
    0.02;  // of a flank's height: half width of contact at loads that steel bears
inline constexpr double kWidest =
    0.1;  // of a flank's height: half width of even pressures below which contact grows with loads

inline constexpr double kFlattest = 1e3;  // of a flank's height: radii of flanks that hardly part, or overlap
                                          // in fillets, where they carry no force

/// m, of a flank across the profile.
inline double height(const ExactFlanks& flanks) {
  const ExactFlanks::Extent extent = flanks.extent();
  return extent.upper - extent.lower;
}
/// m, v in the middle between its ends.
inline double middle(const ExactFlanks& flanks) {
  const ExactFlanks::Extent extent = flanks.extent();
  return (extent.upper + extent.lower) / 2;
}

}  // namespace elastogear::contact
