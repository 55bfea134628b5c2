#pragma once
// The lowest eigenmodes, window after window up the spectrum, each with a shift of its own and a count check.

#include <functional>
#include <limits>

#include "elastogear/reduction/eigen_options.h"
#include "reduction/eigensolver/block_product.h"
#include "reduction/eigensolver/tall_basis.h"
#include "reduction/eigensolver/window_size.h"
#include "reduction/slepc/spectral_transform.h"

namespace elastogear::reduction {

/// Throws Error naming both numbers unless `known` eigenvalues are all of the `exact` ones under sigma,
/// rad^2/s^2.
void require_complete(int known, int exact, double sigma);

/// What spectrum slicing is asked for.
struct Slicing {
  int n_modes = 1;
  double tolerance = 1e-10;  ///< relative error of theta at which a mode counts as converged
  bool verify_count = true;  ///< compare the number of modes with the inertia of K - sigma M
  WindowSize window = {};    ///< 0: automatic
  int most_columns = std::numeric_limits<int>::max();  ///< of the basis; 200 are always allowed
  double first_shift = 0;                              ///< rad^2/s^2
  double counted_below = 0;  ///< rad^2/s^2, known to have the last of n_modes below; 0: unknown
  double lower = -std::numeric_limits<double>::infinity();  ///< rad^2/s^2: modes below it are left out
  double upper = std::numeric_limits<double>::infinity();   ///< rad^2/s^2: the n_modes lie below it
  int n_below = 0;                                          ///< eigenvalues below `lower`
  bool whole_pairs = false;  ///< deliver also the modes above n_modes that are as good as equal to the last
  int most_blocks = std::numeric_limits<int>::max();  ///< after so many the search ends with what it has
  SearchState start = {};                             ///< of a search to be continued
};

/// Converged eigenvalues, ascending, and the first that is not, at a look at the Ritz values.
struct Look {
  double sigma = 0;
  Eigen::VectorXd eigenvalue, error;  ///< errors relative, of 1 / (lambda - sigma)
  int n_converged = 0;
};

/// What the search tells on its way, on all ranks.
struct SliceHooks {
  ModeSink mode = {};
  std::function<void(const SearchState&)> window = {};  ///< after the modes of a window
  std::function<void(const Look&, int n_blocks)> look = {};
  std::function<void(double fraction)> progress = {};
  std::function<void(double eigenvalue)> lowest = {};  ///< the first mode's, before it is delivered
};

/// Makes the basis, with room for so many columns, when that is known.
using MakeBasis = std::function<TallBasis&(int n_columns)>;

/// Block Lanczos with spectrum slicing (docs/theory, section 2.2). Window ends lie in gaps of the spectrum,
/// so that equal or close eigenvalues stay together. Returns the state after the last window. K: symmetric;
/// M: symmetric and definite; their layouts are equal. Memory: the factor and the basis, 2 to 4 windows of
/// vectors.
SearchState slice_spectrum(Mat K, Mat M, SpectralTransform& transform, const Slicing& slicing,
                           const SliceHooks& hooks, const MakeBasis& make_basis);

}  // namespace elastogear::reduction
