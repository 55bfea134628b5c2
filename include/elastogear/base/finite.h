#pragma once
// A test of many numbers at the speed of memory.

#include <Eigen/Core>

namespace elastogear {

/// Whether all n numbers are finite: 0 x is zero unless x is infinite or no number, and the sum is
/// vectorised, which neither std::isfinite nor Eigen's allFinite() is.
template <class T>
bool all_finite(const T* x, Eigen::Index n) {
  return n == 0 || (T(0) * Eigen::Map<const Eigen::Array<T, Eigen::Dynamic, 1>>(x, n)).sum() == 0;
}
template <class T>
bool all_finite(const Eigen::PlainObjectBase<T>& x) {
  return all_finite(x.data(), x.size());
}

}  // namespace elastogear
