#include "reduction/slepc/shift_placement.h"

#include <algorithm>
#include <cmath>

namespace elastogear::reduction {
namespace {

constexpr double kAim = 0.45;      // of a window's modes: to lie under its shift
constexpr double kTooMany = 0.65;  // the same: move the shift down
constexpr int kShifts = 4;         // tries to place one
constexpr double kWeyl = 1.5;      // exponent of N(lambda) in a solid
constexpr int kFewModes = 16;      // too few to see an exponent of their own

// The eigenvalue up to which `more` modes are expected above the known ones, by the power law N(lambda) of
// the last of these, or by their mean distance where the spectrum does not begin above zero.
double extrapolate(const Progression& search, double more) {
  const SearchState& state = search.state;
  const auto n = state.eigenvalue.size();
  const auto before = search.slicing.n_below;
  const auto half = std::max<Eigen::Index>(n / 2, n - static_cast<Eigen::Index>(2 * more));
  if (state.eigenvalue(0) <= 0) {
    const Eigen::Index from = n > 1 ? half - 1 : 0;
    const double width = state.lower - state.eigenvalue(from);
    return state.lower + more * width / static_cast<double>(n - from);
  }
  double exponent = kWeyl;
  if (n >= kFewModes) {
    exponent = std::log(static_cast<double>(before + n) / static_cast<double>(before + half)) /
               std::log(state.lower / state.eigenvalue(half - 1));
    exponent = std::clamp(exponent, kWeyl / 3, 3 * kWeyl);
  }
  return state.lower * std::pow(1 + more / static_cast<double>(before + n), 1 / exponent);
}

double largest_diagonal_ratio(const Progression& search) {
  UniqueVec k, m;
  PetscReal largest = 0;
  check(MatCreateVecs(search.K, k.out(), m.out()));
  check(MatGetDiagonal(search.K, k));
  check(MatGetDiagonal(search.M, m));
  check(VecPointwiseDivide(k, k, m));
  check(VecNorm(k, NORM_INFINITY, &largest));
  return largest;
}

// The factor at the first shift or, where more than `most` eigenvalues lie under it, at a lower one.
Shift descend(const Progression& search, double most) {
  Shift shift{search.slicing.first_shift, 0};
  shift.below = search.transform.factorise(shift.sigma);
  if (shift.below <= most) return shift;
  double upper = shift.sigma, step = 1e-6 * largest_diagonal_ratio(search);
  for (; shift.below > most; step *= 4) {  // down to where there are few
    upper = shift.sigma;
    shift.sigma -= step;
    shift.below = search.transform.factorise(shift.sigma);
  }
  for (int i = 0; i < kShifts && shift.below == 0; ++i) {  // and up to where there are some
    const Shift empty = shift;
    shift.sigma = (shift.sigma + upper) / 2;
    shift.below = search.transform.factorise(shift.sigma);
    if (shift.below <= most) continue;
    upper = shift.sigma;
    shift = empty;
  }
  shift.below = search.transform.factorise(shift.sigma);
  return shift;
}

// The eigenvalue below which `more` modes are expected in an interval of which none is known yet.
double first_in_interval(const Progression& search, double more) {
  const Slicing& slicing = search.slicing;
  const double width =
      std::isfinite(slicing.upper) ? slicing.upper - slicing.lower : largest_diagonal_ratio(search);
  return slicing.lower + width * std::min(0.5, more / slicing.n_modes);
}

}  // namespace

Shift place_shift(const Progression& search, int modes) {
  const SearchState& state = search.state;
  const double half = std::max(1.0, kAim * modes);
  if (search.delivered() == 0 && !std::isfinite(search.slicing.lower)) return descend(search, half);
  Shift shift{search.delivered() == 0 ? first_in_interval(search, half) : extrapolate(search, half), 0};
  for (int i = 1;; ++i) {
    shift.below = search.transform.factorise(shift.sigma);
    const int under = shift.below - search.known();
    if (under <= std::max(1.0, kTooMany * modes) || i == kShifts) return shift;
    shift.sigma = state.lower + (shift.sigma - state.lower) * half / under;
  }
}

}  // namespace elastogear::reduction
