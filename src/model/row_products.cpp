#include "elastogear/model/row_products.h"

#include "elastogear/base/instructions.h"

namespace elastogear::model {
namespace {

using Eigen::Index;

template <int kBytes>
struct Register {
  typedef double Lanes __attribute__((vector_size(kBytes), aligned(alignof(double)), may_alias));
  static constexpr Index kLanes = kBytes / static_cast<Index>(sizeof(double));
  [[gnu::always_inline]] static const Lanes& at(const double* p) {
    return *reinterpret_cast<const Lanes*>(p);
  }
};

// Products of the rows with x. Two partial sums a row, so that no addition waits for the last.
template <class R>
[[gnu::always_inline]] inline void multiply_three(const double* rows, const double* x, Index n, double* sum) {
  using Lanes = typename R::Lanes;
  constexpr Index L = R::kLanes;
  Lanes s[3][2] = {};
  Index k = 0;
  for (; k + 2 * L <= n; k += 2 * L)
#pragma GCC unroll 2
    for (Index half = 0; half < 2; ++half)
#pragma GCC unroll 3
      for (int d = 0; d < 3; ++d) s[d][half] += R::at(rows + d * n + k + half * L) * R::at(x + k + half * L);
  for (int d = 0; d < 3; ++d) {
    const Lanes both = s[d][0] + s[d][1];
    sum[d] = 0;
    for (Index i = 0; i < L; ++i) sum[d] += both[i];
    for (Index i = k; i < n; ++i) sum[d] += rows[d * n + i] * x[i];
  }
}

constexpr int kFirst[6] = {0, 1, 2, 0, 0, 1}, kSecond[6] = {0, 1, 2, 1, 2, 2};  // entries of A diag(w) A'

template <class R>
[[gnu::always_inline]] inline void square_three(const double* rows, const double* w, Index n, double* sum) {
  using Lanes = typename R::Lanes;
  constexpr Index L = R::kLanes;
  Lanes s[6] = {};
  Index k = 0;
  for (; k + L <= n; k += L) {
    const Lanes weight = R::at(w + k);
#pragma GCC unroll 6
    for (int e = 0; e < 6; ++e)
      s[e] += R::at(rows + kFirst[e] * n + k) * R::at(rows + kSecond[e] * n + k) * weight;
  }
  for (int e = 0; e < 6; ++e) {
    sum[e] = 0;
    for (Index i = 0; i < L; ++i) sum[e] += s[e][i];
    for (Index i = k; i < n; ++i) sum[e] += rows[kFirst[e] * n + i] * rows[kSecond[e] * n + i] * w[i];
  }
}

// y lies apart from the rows. Code for both cases would round differently, by where they lie in memory.
template <class R>
[[gnu::always_inline]] inline void add_three(const double* rows, const double* f, double* __restrict y,
                                             Index n) {
  using Lanes = typename R::Lanes;
  constexpr Index L = R::kLanes;
  Index k = 0;
  for (; k + L <= n; k += L)
    *reinterpret_cast<Lanes*>(y + k) =
        R::at(y + k) + (f[0] * R::at(rows + k) + f[1] * R::at(rows + n + k) + f[2] * R::at(rows + 2 * n + k));
  for (; k < n; ++k) y[k] += f[0] * rows[k] + f[1] * rows[n + k] + f[2] * rows[2 * n + k];
}

struct Kernels {
  void (*products)(const double* rows, const double* x, Index n, double* sum);
  void (*squares)(const double* rows, const double* w, Index n, double* sum);
  void (*add)(const double* rows, const double* f, double* y, Index n);
};

template <class R>
constexpr Kernels kPortable{
    [](const double* rows, const double* x, Index n, double* sum) { multiply_three<R>(rows, x, n, sum); },
    [](const double* rows, const double* w, Index n, double* sum) { square_three<R>(rows, w, n, sum); },
    [](const double* rows, const double* f, double* __restrict y, Index n) { add_three<R>(rows, f, y, n); }};

#ifdef __x86_64__
[[gnu::target("avx2,fma")]] void products_avx2(const double* rows, const double* x, Index n, double* sum) {
  multiply_three<Register<32>>(rows, x, n, sum);
}
[[gnu::target("avx2,fma")]] void squares_avx2(const double* rows, const double* w, Index n, double* sum) {
  square_three<Register<32>>(rows, w, n, sum);
}
[[gnu::target("avx2,fma")]] void add_avx2(const double* rows, const double* f, double* __restrict y,
                                          Index n) {
  add_three<Register<32>>(rows, f, y, n);
}
[[gnu::target("avx512f")]] void products_avx512(const double* rows, const double* x, Index n, double* sum) {
  multiply_three<Register<64>>(rows, x, n, sum);
}
[[gnu::target("avx512f")]] void squares_avx512(const double* rows, const double* w, Index n, double* sum) {
  square_three<Register<64>>(rows, w, n, sum);
}
[[gnu::target("avx512f")]] void add_avx512(const double* rows, const double* f, double* __restrict y,
                                           Index n) {
  add_three<Register<64>>(rows, f, y, n);
}
#endif

Kernels best_kernels() {
#ifdef __x86_64__
  if (best_instructions() == Instructions::avx512) return {products_avx512, squares_avx512, add_avx512};
  if (best_instructions() == Instructions::avx2) return {products_avx2, squares_avx2, add_avx2};
#endif
  return kPortable<Register<16>>;
}

const Kernels& kernels() {
  static const Kernels best = best_kernels();
  return best;
}

}  // namespace

Eigen::Vector3d three_products(const double* rows, const double* x, Index n) {
  Eigen::Vector3d sum;
  kernels().products(rows, x, n, sum.data());
  return sum;
}

Eigen::Matrix3d weighted_squares(const double* rows, const double* w, Index n) {
  double sum[6];
  kernels().squares(rows, w, n, sum);
  Eigen::Matrix3d squares;
  for (int e = 0; e < 6; ++e) squares(kFirst[e], kSecond[e]) = squares(kSecond[e], kFirst[e]) = sum[e];
  return squares;
}

void add_three_rows(const double* rows, const Eigen::Vector3d& f, double* y, Index n) {
  kernels().add(rows, f.data(), y, n);
}

}  // namespace elastogear::model
