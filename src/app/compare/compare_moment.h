#pragma once
// The times at which two files are compared, and the nodes that belong together.

#include <Eigen/Core>

#include "app/compare/compare_options.h"

namespace elastogear::app {

/// First of the largest values (n_t) between -from and -to, as far as they are given; Error when no time lies
/// there.
Eigen::Index peak_within(const CompareSettings& settings, const Eigen::VectorXd& time,
                         const Eigen::VectorXd& values);

struct Moment {
  double time, reference_time;  ///< s, in the file and in its reference
};

/// Times that -at and -reference_at choose; `peak`: time of the reference's largest value, for -at peak.
/// Error when a time lies outside of its file.
Moment moment(const CompareSettings& settings, const Eigen::VectorXd& time,
              const Eigen::VectorXd& reference_time, double peak);

/// The reference's times between -from and -to (or begin and end) that the file covers too. Empty when times
/// mean different things in both files (-reference_at is given, or -at last).
Eigen::VectorXd common_times(const CompareSettings& settings, const Eigen::VectorXd& time,
                             const Eigen::VectorXd& reference_time, double begin, double end);

}  // namespace elastogear::app
