#include "recovery/tensors/largest_principal.h"

#include <array>
#include <cmath>
#include <numbers>

#include "elastogear/base/instructions.h"

// Vectors are passed between inlined functions alone, whose calling convention does not matter.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace elastogear::recovery {
namespace {

constexpr int kLanes = 8;  // tensors at a time

typedef double Lanes __attribute__((vector_size(kLanes * sizeof(double))));
typedef long LaneMask __attribute__((vector_size(kLanes * sizeof(long))));

constexpr double kRoot2 = std::numbers::sqrt2, kRoot3 = std::numbers::sqrt3, kRoot6 = kRoot2 * kRoot3;

// Coefficients of cos(2/3 acos(1 - z)) in powers of z: of each the last is about half of the one before.
constexpr auto kCosine = [] {
  std::array<double, 52> c{1};
  for (std::size_t k = 0; k + 1 < c.size(); ++k) {
    const auto n = static_cast<double>(k);
    c[k + 1] = c[k] * (n * n - 4. / 9) / ((2 * n + 1) * (n + 1));
  }
  return c;
}();

[[gnu::always_inline]] inline double root(double x) { return std::sqrt(x); }
[[gnu::always_inline]] inline Lanes root(const Lanes& x) {
  Lanes r;
  for (int i = 0; i < kLanes; ++i) r[i] = std::sqrt(x[i]);
  return r;
}
[[gnu::always_inline]] inline double choose(bool first, double a, double b) { return first ? a : b; }
[[gnu::always_inline]] inline Lanes choose(const LaneMask& first, const Lanes& a, const Lanes& b) {
  return first ? a : b;
}

// A symmetric tensor without a mean and of norm 1, xx yy zz xy yz xz, and its square.
template <class T>
struct Tensor {
  T xx, yy, zz, xy, yz, xz;
};

template <class T>
[[gnu::always_inline]] inline Tensor<T> square(const Tensor<T>& s) {
  return {s.xx * s.xx + s.xy * s.xy + s.xz * s.xz, s.yy * s.yy + s.xy * s.xy + s.yz * s.yz,
          s.zz * s.zz + s.yz * s.yz + s.xz * s.xz, s.xy * (s.xx + s.yy) + s.yz * s.xz,
          s.yz * (s.yy + s.zz) + s.xy * s.xz,      s.xz * (s.xx + s.zz) + s.xy * s.yz};
}

template <class T>
[[gnu::always_inline]] inline T determinant(const Tensor<T>& s) {
  return s.xx * (s.yy * s.zz - s.yz * s.yz) - s.xy * (s.xy * s.zz - s.yz * s.xz) +
         s.xz * (s.xy * s.yz - s.yy * s.xz);
}

// The coordinates of a tensor's deviator in an orthonormal basis.
template <class T>
[[gnu::always_inline]] inline void deviator(const Tensor<T>& s, T* u) {
  u[0] = (s.xx - s.yy) * (1 / kRoot2);
  u[1] = (s.zz + s.zz - s.xx - s.yy) * (1 / kRoot6);
  u[2] = kRoot2 * s.xy;
  u[3] = kRoot2 * s.yz;
  u[4] = kRoot2 * s.xz;
}

// The product of the differences between the principal values.
template <class T>
[[gnu::always_inline]] inline T differences(const Tensor<T>& s) {
  constexpr int kCoordinates = 5;
  T u[kCoordinates], v[kCoordinates], sum{};
  deviator(s, u);
  deviator(square(s), v);
  for (int i = 0; i < kCoordinates; ++i)
    for (int j = 0; j < i; ++j) {
      const T w = u[i] * v[j] - u[j] * v[i];
      sum += w * w;
    }
  return kRoot3 * root(sum);
}

template <class T>
[[gnu::always_inline]] inline T largest(const Tensor<T>& sigma) {
  Tensor<T> s = sigma;
  const T mean = (s.xx + s.yy + s.zz) * (1. / 3);
  s.xx -= mean;
  s.yy -= mean;
  s.zz -= mean;
  const T norm =
              root(s.xx * s.xx + s.yy * s.yy + s.zz * s.zz + 2. * (s.xy * s.xy + s.yz * s.yz + s.xz * s.xz)),
          inverse = 1. / choose(norm > 0., norm, norm + 1.);
  s = {s.xx * inverse, s.yy * inverse, s.zz * inverse, s.xy * inverse, s.yz * inverse, s.xz * inverse};
  const T x = 3 * kRoot6 * determinant(s), y = kRoot2 * differences(s),
          away = root(0.5 * choose(x > 0., 1. + x, 1. - x)), h = choose(x > 0., away, 0.5 * y / away),
          z = 1. - h;
  T cosine = z * kCosine.back();
  for (std::size_t k = kCosine.size() - 2; k > 0; --k) cosine = (cosine + kCosine[k]) * z;
  return mean + norm * ((kRoot2 / kRoot3) * (cosine + kCosine[0]));
}

[[gnu::always_inline]] inline void together(const double* s, double* values) {
  Lanes t[6] = {}, result;
  for (int i = 0; i < kLanes; ++i)
    for (int c = 0; c < 6; ++c) t[c][i] = s[6 * i + c];
  result = largest<Lanes>({t[0], t[1], t[2], t[3], t[4], t[5]});
  for (int i = 0; i < kLanes; ++i) values[i] = result[i];
}

[[gnu::always_inline]] inline void each(const double* s, Eigen::Index n, double* values) {
  Eigen::Index i = 0;
  for (; i + kLanes <= n; i += kLanes) together(s + 6 * i, values + i);
  for (; i < n; ++i) {
    const double* t = s + 6 * i;
    values[i] = largest<double>({t[0], t[1], t[2], t[3], t[4], t[5]});
  }
}

void each_portable(const double* s, Eigen::Index n, double* values) { each(s, n, values); }

#ifdef __x86_64__
[[gnu::target("avx2,fma")]] void each_avx2(const double* s, Eigen::Index n, double* values) {
  each(s, n, values);
}
[[gnu::target("avx512f")]] void each_avx512(const double* s, Eigen::Index n, double* values) {
  each(s, n, values);
}
#endif

using Each = void (*)(const double*, Eigen::Index, double*);

Each best_each() {
#ifdef __x86_64__
  if (best_instructions() == Instructions::avx512) return each_avx512;
  if (best_instructions() == Instructions::avx2) return each_avx2;
#endif
  return each_portable;
}

}  // namespace

void largest_principal(const double* tensors, Eigen::Index n, double* values) {
  static const Each each_of = best_each();
  each_of(tensors, n, values);
}

}  // namespace elastogear::recovery
