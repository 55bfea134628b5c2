#pragma once
// The options of compare.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/options/file_time.h"
#include "app/options/options.h"

namespace elastogear::app {

/// What the options ask for. Times are in s, or kLastTime.
struct CompareSettings {
  bool by_position = false;       ///< nodes of two stress files belong together by position, not by number
  double match_tolerance = 0;     ///< m, how far apart two such nodes may lie
  std::optional<double> at = {};  ///< nothing: where the reference has its peak
  std::optional<double> reference_at = {};               ///< in the reference; nothing: at the same time
  std::map<std::string, std::vector<double>> node = {};  ///< by body, numbers in the reference
  std::optional<double> from = {}, to = {};              ///< of the signals over time
  std::string output = {};  ///< first part of the tables' names; empty: they are only printed
};

/// Rows for the options of compare.
OptionTable compare_table();

CompareSettings compare_settings(const Options& options);

}  // namespace elastogear::app
