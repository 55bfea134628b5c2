#pragma once
// Eigenmodes of small bodies of which a large part of the spectrum is wanted: all of it, by LAPACK on rank 0.

#include "elastogear/base/progress.h"
#include "elastogear/reduction/eigen_options.h"

namespace elastogear::reduction {

constexpr double kEqual = 1e-5;  ///< relative difference of eigenvalues that belong together

/// Returns whether so many of the n modes are wanted that a Krylov basis for them would fill the space, on a
/// body small enough for dense matrices.
bool suits_dense(int n, int n_modes);

/// find_eigenmodes without a shift or a search (docs/theory, section 2.2). Memory on rank 0: 5 n^2
/// numbers.
Eigenmodes find_by_lapack(Mat K, Mat M, const EigenOptions& options, const ModeSink& sink,
                          const Progress& progress);

}  // namespace elastogear::reduction
