#pragma once
// How boxes lie in memory: as floats, of a length that is a compile-time constant.

#include <type_traits>

#include "elastogear/contact/bvh.h"

namespace elastogear::contact {

constexpr float kUlp = 0x1p-24F;  ///< relative error of rounding to float

/// Calls f with padded_half(k) as a std::integral_constant: loops over the intervals then have a fixed
/// length.
template <class F>
void with_half(int k, F f) {
  switch (padded_half(k)) {
    case 4:
      return f(std::integral_constant<int, 4>());
    case 8:
      return f(std::integral_constant<int, 8>());
    case 12:
      return f(std::integral_constant<int, 12>());
    default:
      return f(std::integral_constant<int, 16>());
  }
}

}  // namespace elastogear::contact
