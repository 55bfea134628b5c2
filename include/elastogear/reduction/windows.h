#pragma once
// The lowest eigenmodes, window after window up the spectrum, each with a shift of its own and a count check.

#include <limits>

#include "elastogear/reduction/eigenmodes.h"
#include "elastogear/reduction/factorisation.h"

namespace elastogear::reduction {

/// A stretch of the spectrum between two counts.
struct Window {
  double lower =
      -std::numeric_limits<double>::infinity();  ///< rad^2/s^2; no eigenvalue lies close to either end
  double upper = 0;
  int below = 0;               ///< eigenvalues under `lower`
  Eigen::VectorXd eigenvalue;  ///< those found between, ascending
};

/// Throws Error naming both numbers unless (K, M) has exactly window.below + window.eigenvalue.size()
/// eigenvalues under window.upper. Factorises at window.upper.
void require_complete(ShiftedFactor& factor, const Window& window);

/// find_eigenmodes by block Lanczos in windows. Window ends lie in gaps of the spectrum, so that equal or
/// close eigenvalues stay together. Memory: the factor and about 2 options.window vectors.
Eigenmodes find_by_windows(Mat K, Mat M, const EigenOptions& options, const ModeSink& sink,
                           const Progress& progress);

}  // namespace elastogear::reduction
