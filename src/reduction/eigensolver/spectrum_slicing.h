#pragma once
// The lowest eigenmodes, window after window up the spectrum, each with a shift of its own and a count check.

#include "elastogear/base/progress.h"
#include "elastogear/reduction/eigen_options.h"
#include "reduction/eigensolver/factorisation.h"

namespace elastogear::reduction {

/// Modes found in windows and columns that go through the factor together.
struct WindowSize {
  int modes = 0, block = 0;
};

/// Sizes that make the cost per mode least, by the work of a factorisation, of the solves and of the
/// orthogonalisation, with a basis no larger than one and a half factors or 0.8 GB. n: rows of K. `asked` > 0
/// keeps its value.
WindowSize choose_window(const FactorSize& factor, int n, WindowSize asked);

/// Throws Error naming both numbers unless `known` eigenvalues are all of the `exact` ones under sigma,
/// rad^2/s^2.
void require_complete(int known, int exact, double sigma);

/// find_eigenmodes by block Lanczos in windows (docs/theory.md, section 2.2). Window ends lie in gaps of the
/// spectrum, so that equal or close eigenvalues stay together. Memory: the factor and the basis, 2 to 4
/// options.window vectors.
Eigenmodes find_by_slices(Mat K, Mat M, const EigenOptions& options, const ModeSink& sink,
                          const Progress& progress);

}  // namespace elastogear::reduction
