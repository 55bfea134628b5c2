#pragma once
// How many modes spectrum slicing looks for at a time, and how many columns go through the factor together.

#include <limits>

#include "reduction/eigensolver/factorisation.h"

namespace elastogear::reduction {

/// Modes found in windows and columns that go through the factor together.
struct WindowSize {
  int modes = 0, block = 0;
};

/// Columns that a Krylov basis without restarts needs until so many modes on both sides of the shift have
/// converged to the tolerance, relative.
double needed_columns(int modes, int block, double tolerance = 1e-10);

/// Columns that there is to be room for among n rows: more than are needed, and not more than `most_columns`
/// unless these are less than 200.
int columns_with_room(const WindowSize& size, int n, int most_columns);

/// Sizes that make the cost per mode least, by the work of a factorisation, of the solves and of the
/// orthogonalisation, with a basis no larger than one and a half factors or 0.8 GB, nor than `most_columns`
/// where these are more than some 200. n: rows of K. `asked` > 0 keeps its value.
WindowSize choose_window(const FactorSize& factor, int n, WindowSize asked,
                         int most_columns = std::numeric_limits<int>::max());

}  // namespace elastogear::reduction
