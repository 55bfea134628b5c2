#pragma once

#include <algorithm>

namespace elastogear {

/// Sorts the values and leaves each of them once.
template <class Values>
void sort_unique(Values& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

}  // namespace elastogear
