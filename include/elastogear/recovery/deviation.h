#pragma once
// How far results are from a reference: stress tensors at nodes (the paper's Tabs. 3 and 4) and signals over
// time.

#include <Eigen/Core>
#include <vector>

#include "elastogear/recovery/stress.h"

namespace elastogear::recovery {

/// Columns: xx yy zz xy yz xz, von Mises, Rankine.
using StressMeasures = Eigen::Matrix<double, 8, 1>;

/// Deviations at one node or over many, as shares (1 = 100 %); not finite where the reference is zero.
struct StressDeviation {
  StressMeasures relative;      ///< of each measure's own reference
  StressMeasures of_von_mises;  ///< of the reference's von Mises stress
};

/// stress, reference: 6 n, Pa, the same n nodes in the same order. Over several nodes both numerator and
/// denominator are root sums of squares (docs/theory, Eq. (4.4)).
StressDeviation stress_deviation(const Eigen::VectorXd& stress, const Eigen::VectorXd& reference);

struct Extremum {
  double value = 0;  ///< largest magnitude
  double time = 0;   ///< s
};

struct SignalDeviation {
  double l2 = 0;  ///< 1, of the difference over that of the reference; not finite where that is zero
  Extremum peak, reference_peak;
};

/// docs/theory, Eq. (4.5). signal, reference: n_t values at the times (s, increasing); integrals by the
/// trapezoidal rule.
SignalDeviation signal_deviation(const Eigen::VectorXd& time, const Eigen::VectorXd& signal,
                                 const Eigen::VectorXd& reference);

/// Columns of `values` (n x n_t) at other times, linear in between; Error when one lies outside of `time`.
Eigen::MatrixXd at_times(const Eigen::VectorXd& time, const Eigen::MatrixXd& values,
                         const Eigen::VectorXd& wanted);

/// For each node of the reference its place among `node`; Error naming the first that is missing.
std::vector<int> match_numbers(const std::vector<int>& node, const std::vector<int>& reference);

/// For each point of the reference the nearest of X (3 x n, m). Error when a point has none within the
/// tolerance (m).
std::vector<int> match_positions(const Eigen::Matrix3Xd& X, const Eigen::Matrix3Xd& reference,
                                 double tolerance);

}  // namespace elastogear::recovery
