#pragma once
// One number that tells whether two computations have the same input.

#include <array>
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
  /// n numbers in a row, several times faster; or what block_digest told of them.
  void add_block(const double* numbers, std::size_t n);
  void add_block(const std::array<std::uint64_t, 4>& digest, std::size_t n);
  std::uint64_t value() const { return state_; }
  std::string text() const;

 private:
  std::uint64_t state_ = 0;
};

/// Four hashes of n numbers in a row.
std::array<std::uint64_t, 4> block_digest(const double* numbers, std::size_t n);

}  // namespace elastogear
