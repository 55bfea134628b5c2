#pragma once
// Times of a result or stress file that options name.

#include <limits>
#include <string>

#include "app/options/options.h"

namespace elastogear::app {

/// Stands for the last time of a file.
constexpr double kLastTime = std::numeric_limits<double>::infinity();

/// A time (s), or kLastTime for the word last.
inline double file_time(const Options& options, const std::string& name) {
  return options.text(name) == "last" ? kLastTime : options.number(name);
}

}  // namespace elastogear::app
