#pragma once
// The library never prints: long work reports through this callback, the program shows it.

#include <functional>
#include <string_view>

namespace elastogear {

/// stage: what is being done ("eigenmodes"); fraction: 0..1 of that stage. May be empty.
using Progress = std::function<void(std::string_view stage, double fraction)>;

inline void report(const Progress& progress, std::string_view stage, double fraction) {
  if (progress) progress(stage, fraction);
}

}  // namespace elastogear
