#pragma once
// Figures of signals over the roll angle: means, ranges and Fourier orders (docs/theory.md, section 10.1).
// Roll angles count pitches of the drive's first gear, so that order 1 is the mesh frequency.

#include <Eigen/Core>
#include <optional>

namespace elastogear::evaluation {

/// Largest less smallest value; 0 without values.
double peak_to_peak(const Eigen::VectorXd& signal);

/// Largest over mean value, Eq. (10.11); NaN where the mean is not positive.
double dynamic_factor(const Eigen::VectorXd& force);

/// Number of whole pitches that evenly spaced roll angles fill, the end of the last one excluded; nothing
/// when they are not even or fill no whole pitches.
std::optional<int> whole_pitches(const Eigen::VectorXd& roll);

/// One-sided amplitudes of a signal, by order.
struct Spectrum {
  Eigen::VectorXd order;      ///< n, per pitch, ascending, without 0
  Eigen::VectorXd amplitude;  ///< n, in the signal's unit
  Eigen::VectorXd phase;      ///< n, rad, against a cosine of the roll angle; empty with a window
};

/// Fourier orders of a signal that repeats, sampled at roll angles that fill whole pitches: Eq. (10.1).
/// Throws Error when they do not.
Spectrum fourier_orders(const Eigen::VectorXd& roll, const Eigen::VectorXd& signal);

/// Orders of a signal of a run in time: resampled linearly at even roll angles, less its mean, under Hann's
/// window, Eq. (10.2). Throws Error unless roll angles increase strictly, over at least two pitches.
Spectrum windowed_orders(const Eigen::VectorXd& roll, const Eigen::VectorXd& signal);

/// Amplitude of the order nearest to `order`; 0 where the spectrum does not reach.
double amplitude_at(const Spectrum& spectrum, double order);

}  // namespace elastogear::evaluation
