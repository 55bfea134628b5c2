#pragma once
// A part of the spectrum.

#include <limits>

namespace elastogear::reduction {

/// Bounds of eigenvalues, rad^2/s^2; infinite where there is none.
struct Interval {
  double lower = -std::numeric_limits<double>::infinity(), upper = std::numeric_limits<double>::infinity();
};

}  // namespace elastogear::reduction
