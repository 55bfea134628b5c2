#pragma once
// Figures of signals over the roll angle: means, ranges and Fourier orders (docs/theory, section 10.1).
// Roll angles count pitches of the drive's first gear, so that order 1 is the mesh frequency.

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace elastogear::evaluation {

/// Largest less smallest value; 0 without values.
double peak_to_peak(const Eigen::VectorXd& signal);

/// Largest over mean value, Eq. (10.11); NaN where the mean is not positive.
double dynamic_factor(const Eigen::VectorXd& force);

/// Evenly spaced roll angles that fill whole pitches, the end of the last one excluded.
struct EvenPositions {
  int pitches = 0;
  Eigen::Index n = 0;               ///< positions
  std::vector<Eigen::Index> index;  ///< of each roll angle
};
/// The even positions that ascending roll angles are, but for up to a tenth that is missing; nothing when
/// they are others.
std::optional<EvenPositions> even_positions(const Eigen::VectorXd& roll);

/// One-sided amplitudes of a signal, by order.
struct Spectrum {
  Eigen::VectorXd order;      ///< n, per pitch, ascending, without 0
  Eigen::VectorXd amplitude;  ///< n, in the signal's unit
  Eigen::VectorXd phase;      ///< n, rad, against a cosine of the roll angle; empty with a window
};

/// Fourier orders of a signal that repeats, at even positions of whole pitches: Eq. (10.1). Between its
/// neighbours a missing one is taken to be linear. Throws Error for other roll angles.
Spectrum fourier_orders(const Eigen::VectorXd& roll, const Eigen::VectorXd& signal);

/// Do roll angles of a run in time increase strictly, over at least two pitches? Only then it has orders.
bool rolls_on(const Eigen::VectorXd& roll);

/// Orders of a signal of a run in time: resampled linearly at even roll angles, less its mean, under Hann's
/// window, Eq. (10.2). Throws Error unless roll angles increase strictly, over at least two pitches.
Spectrum windowed_orders(const Eigen::VectorXd& roll, const Eigen::VectorXd& signal);

/// Amplitude of the order nearest to `order`; 0 where the spectrum does not reach.
double amplitude_at(const Spectrum& spectrum, double order);

}  // namespace elastogear::evaluation
