#pragma once
// Where spectrum slicing puts its next shift.

#include "reduction/slepc/spectrum_slicing.h"

namespace elastogear::reduction {

struct Shift {
  double sigma = 0;
  int below = 0;  ///< eigenvalues under it
};

/// A search between two windows.
struct Progression {
  Mat K, M;
  SpectralTransform& transform;
  const Slicing& slicing;
  const SearchState& state;

  int delivered() const { return static_cast<int>(state.eigenvalue.size()); }
  int known() const { return slicing.n_below + delivered(); }
};

/// A shift with nearly half of the next window's modes under it, and the factor there.
Shift place_shift(const Progression& search, int modes);

}  // namespace elastogear::reduction
