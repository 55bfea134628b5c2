#include "io/hdf5/fletcher32.h"

#include <algorithm>

#include "elastogear/base/instructions.h"

namespace elastogear::io::h5 {
namespace {

constexpr std::uint64_t kModulus = 65535;
constexpr std::size_t kLanes = 16, kMostStripes = 256;  // sums of sums stay below 2^32

typedef std::uint16_t Words __attribute__((vector_size(2 * kLanes), aligned(2), may_alias));
typedef std::uint32_t Sums __attribute__((vector_size(4 * kLanes), aligned(4), may_alias));

// Sum of n words, and sum of its values after each word.
struct TwoSums {
  std::uint64_t sum = 0, of_sums = 0;
};

// Sums of stripes of kLanes words, at most kMostStripes. After n words, word t kLanes + j of stripe t stands
// n - t kLanes - j times in the sum of sums: each lane counts stripes, and j is taken off.
[[gnu::always_inline]] inline TwoSums sums_of_stripes(const std::uint16_t* word, std::size_t n_stripes) {
  Sums sum = {}, of_sums = {};
  for (std::size_t t = 0; t < n_stripes; ++t) {
    sum += __builtin_convertvector(*reinterpret_cast<const Words*>(word + t * kLanes), Sums);
    of_sums += sum;
  }
  TwoSums both;
  for (std::size_t j = 0; j < kLanes; ++j) {
    both.sum += sum[j];
    both.of_sums += kLanes * std::uint64_t{of_sums[j]} - j * std::uint64_t{sum[j]};
  }
  return both;
}

void append(TwoSums& all, const TwoSums& part, std::size_t n_words) {
  all.of_sums = (all.of_sums + n_words * all.sum + part.of_sums) % kModulus;
  all.sum = (all.sum + part.sum) % kModulus;
}

[[gnu::always_inline]] inline TwoSums sums(const std::uint16_t* word, std::size_t n_words) {
  TwoSums all;
  std::size_t i = 0;
  while (n_words - i >= kLanes) {
    const std::size_t n_stripes = std::min(kMostStripes, (n_words - i) / kLanes);
    append(all, sums_of_stripes(word + i, n_stripes), n_stripes * kLanes);
    i += n_stripes * kLanes;
  }
  for (; i < n_words; ++i) append(all, {word[i], word[i]}, 1);
  return all;
}

TwoSums sums_portable(const std::uint16_t* word, std::size_t n_words) { return sums(word, n_words); }

#ifdef __x86_64__
[[gnu::target("avx2")]] TwoSums sums_avx2(const std::uint16_t* word, std::size_t n_words) {
  return sums(word, n_words);
}
[[gnu::target("avx512f")]] TwoSums sums_avx512(const std::uint16_t* word, std::size_t n_words) {
  return sums(word, n_words);
}
#endif

TwoSums best_sums(const std::uint16_t* word, std::size_t n_words) {
#ifdef __x86_64__
  if (best_instructions() == Instructions::avx512) return sums_avx512(word, n_words);
  if (best_instructions() == Instructions::avx2) return sums_avx2(word, n_words);
#endif
  return sums_portable(word, n_words);
}

}  // namespace

// Modulo 65535 a word with its bytes exchanged is 256 times the word. HDF5 folds carries back into the sums,
// which leaves 65535 in place of 0 unless all words are 0.
std::uint32_t fletcher32(const void* bytes, std::size_t n) {
  const auto* word = static_cast<const std::uint16_t*>(bytes);
  const std::size_t n_words = n / 2;
  const TwoSums both = best_sums(word, n_words);
  const auto folded = [&](std::uint64_t sum) -> std::uint64_t {
    const std::uint64_t swapped = 256 * sum % kModulus;
    if (swapped != 0) return swapped;
    return std::all_of(word, word + n_words, [](std::uint16_t w) { return w == 0; }) ? 0 : kModulus;
  };
  return static_cast<std::uint32_t>(folded(both.of_sums) << 16 | folded(both.sum));
}

}  // namespace elastogear::io::h5
