#pragma once
// Whether two computations have the same input, by one number.

#include <cstdint>
#include <string>

#include "elastogear/base/petsc.h"

namespace elastogear::reduction {

/// A 64-bit hash of everything added, in order.
class Fingerprint {
 public:
  void add(std::uint64_t word);
  void add(double x);
  void add(const std::string& text);
  template <class Range>
  void add_all(const Range& numbers) {
    for (const auto& x : numbers) add(static_cast<double>(x));
  }
  std::uint64_t value() const { return state_; }
  std::string text() const;

 private:
  std::uint64_t state_ = 0;
};

/// Of the entries, their places and their distribution over the ranks. The same on all ranks. Collective.
std::uint64_t fingerprint(Mat A);

}  // namespace elastogear::reduction
