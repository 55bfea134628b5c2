#pragma once
// When simulate writes, and tables of what its sensors saw, from its options.

#include <vector>

#include "app/options/options.h"
#include "elastogear/dynamics/simulate.h"
#include "elastogear/model/result.h"

namespace elastogear::app {

/// Rows of the option table of simulate.
OptionTable output_table();

/// Sets when a run writes. Throws Error for a word that is neither a time nor a file of times.
void set_output_times(const Options& options, dynamics::TimeSettings& time);

/// Paths of the files that write_sensor_tables is going to write.
std::vector<std::string> sensor_tables(const Options& options);

/// One CSV file for each sensor of the finished result, named after both, when -sensor_csv asks for it.
void write_sensor_tables(const Options& options, const model::ResultHeader& header);

}  // namespace elastogear::app
