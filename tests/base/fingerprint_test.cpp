#include "elastogear/base/fingerprint.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace elastogear::fingerprint_test {
using elastogear::Fingerprint;

namespace {

std::uint64_t of_block(const std::vector<double>& numbers) {
  Fingerprint f;
  f.add_block(numbers.data(), numbers.size());
  return f.value();
}

TEST(Fingerprint, of_a_block_tells_each_number_its_place_and_the_length) {
  std::set<std::uint64_t> seen;
  std::size_t n_blocks = 0;
  const auto enter = [&](const std::vector<double>& numbers) {
    seen.insert(of_block(numbers));
    ++n_blocks;
  };
  for (std::size_t n = 0; n < 10; ++n) {
    std::vector<double> numbers(n);
    for (std::size_t i = 0; i < n; ++i) numbers[i] = 0.1 * static_cast<double>(i + 1);
    enter(numbers);
    for (std::size_t i = 0; i < n; ++i) {
      std::vector<double> other = numbers;
      other[i] = -other[i];
      enter(other);
    }
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < i; ++j) {
        std::vector<double> other = numbers;
        std::swap(other[i], other[j]);
        enter(other);
      }
  }
  EXPECT_EQ(seen.size(), n_blocks);
}

TEST(Fingerprint, depends_on_what_was_added_before_a_block) {
  const double number = 1;
  Fingerprint f;
  f.add(2.0);
  f.add_block(&number, 1);
  EXPECT_NE(f.value(), of_block({number}));
}

}  // namespace
}  // namespace elastogear::fingerprint_test
