#include "elastogear/base/fingerprint.h"

#include <bit>
#include <cstdio>

namespace elastogear {

// The mixing of splitmix64 (Steele, Lea & Flood, OOPSLA 2014).
void Fingerprint::add(std::uint64_t word) {
  std::uint64_t z = (state_ ^ word) + 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  state_ = z ^ (z >> 31);
}

void Fingerprint::add(double x) { add(std::bit_cast<std::uint64_t>(x)); }

void Fingerprint::add(const std::string& text) {
  add(static_cast<std::uint64_t>(text.size()));
  for (char c : text) add(static_cast<std::uint64_t>(static_cast<unsigned char>(c)));
}

void Fingerprint::add_block(const double* numbers, std::size_t n) { add_block(block_digest(numbers, n), n); }

void Fingerprint::add_block(const std::array<std::uint64_t, 4>& digest, std::size_t n) {
  add(static_cast<std::uint64_t>(n));
  for (std::uint64_t chain : digest) add(chain);
}

std::string Fingerprint::text() const {
  char digits[17];
  std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(state_));
  return digits;
}

// Four chains, none of which waits for another.
std::array<std::uint64_t, 4> block_digest(const double* numbers, std::size_t n) {
  Fingerprint chain[4];
  for (std::size_t i = 0; i + 4 <= n; i += 4)
    for (std::size_t k = 0; k < 4; ++k) chain[k].add(numbers[i + k]);
  for (std::size_t i = n - n % 4; i < n; ++i) chain[0].add(numbers[i]);
  return {chain[0].value(), chain[1].value(), chain[2].value(), chain[3].value()};
}

}  // namespace elastogear
