#pragma once
// One number that tells whether two computations have the same input.

#include <cstddef>
#include <cstdint>
#include <string>

namespace elastogear {

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
  /// n numbers in a row, several times faster.
  void add_block(const double* numbers, std::size_t n);
  std::uint64_t value() const { return state_; }
  std::string text() const;

 private:
  std::uint64_t state_ = 0;
};

}  // namespace elastogear
