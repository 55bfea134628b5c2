#pragma once
// The verb recover prints the peak and the estimated error of each stress and writes its table.

#include <string>

#include "elastogear/io/result_file.h"
#include "elastogear/recovery/recover.h"

namespace elastogear::app {

/// The output times of a run, and what they are.
struct StressTimes {
  Eigen::VectorXd time;
  io::TimeAxis axis;
};

/// Largest stresses and estimated error of the reduction, with a warning where they are not to be trusted.
void print_stress(const recovery::RecoveredBody& body, const io::StressSet& set, const StressTimes& times);

/// CSV table of the nodes of a small set; of a larger one those of the largest von Mises and the largest
/// principal stress, unless `all` are wanted.
void write_table(const std::string& path, const io::StressSet& set, const StressTimes& times, bool all);

}  // namespace elastogear::app
