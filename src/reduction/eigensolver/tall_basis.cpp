#include "reduction/eigensolver/tall_basis.h"

#include <algorithm>
#include <vector>

namespace elastogear::reduction {
namespace {

constexpr Eigen::Index kSlab = 128;  // rows: four columns of V and 16 vectors then share the first cache
constexpr int kColumns = 4;          // of V in a tile
constexpr int kPad = 4;              // the vectors are padded to a multiple of it, that of the widest tile

// One slab of V and of the vectors W, whose rows are padded with zeros.
struct Slab {
  const double* V;  // kSlab x n_columns
  double* W;        // kSlab x n_vectors
  double* C;        // dot: n_columns x n_vectors x lanes of a register; add: n_columns x n_vectors
  int n_columns, n_vectors;
};

template <int kBytes>
struct Register {
  typedef double Lanes __attribute__((vector_size(kBytes), aligned(alignof(double)), may_alias));
  static constexpr int kLanes = kBytes / static_cast<int>(sizeof(double));
};

// The next columns of V come into the cache while these are in use.
template <int K>
[[gnu::always_inline]] inline void fetch_next(const double* V, Eigen::Index row) {
  for (int k = 0; k < K; ++k) __builtin_prefetch(V + (K + k) * kSlab + row);
}

// C += V' W for K columns and J vectors, the lanes apart.
template <class R, int K, int J>
[[gnu::always_inline]] inline void dot_tile(const double* V, const double* W, double* C, int stride) {
  using Lanes = typename R::Lanes;
  Lanes sum[K][J];
  for (int k = 0; k < K; ++k)
    for (int j = 0; j < J; ++j) sum[k][j] = *reinterpret_cast<const Lanes*>(C + (k * stride + j) * R::kLanes);
  for (Eigen::Index i = 0; i < kSlab; i += R::kLanes) {
    fetch_next<K>(V, i);
    Lanes w[J];
    for (int j = 0; j < J; ++j) w[j] = *reinterpret_cast<const Lanes*>(W + j * kSlab + i);
#pragma GCC unroll 4
    for (int k = 0; k < K; ++k) {
      const Lanes v = *reinterpret_cast<const Lanes*>(V + k * kSlab + i);
#pragma GCC unroll 4
      for (int j = 0; j < J; ++j) sum[k][j] += v * w[j];
    }
  }
  for (int k = 0; k < K; ++k)
    for (int j = 0; j < J; ++j) *reinterpret_cast<Lanes*>(C + (k * stride + j) * R::kLanes) = sum[k][j];
}

// W += V C for K columns and J vectors.
template <class R, int K, int J>
[[gnu::always_inline]] inline void add_tile(const double* V, double* W, const double* C, int stride) {
  using Lanes = typename R::Lanes;
  Lanes c[K][J];
  for (int k = 0; k < K; ++k)
    for (int j = 0; j < J; ++j) c[k][j] = Lanes{} + C[k * stride + j];
  for (Eigen::Index i = 0; i < kSlab; i += R::kLanes) {
    fetch_next<K>(V, i);
    Lanes w[J];
    for (int j = 0; j < J; ++j) w[j] = *reinterpret_cast<const Lanes*>(W + j * kSlab + i);
#pragma GCC unroll 4
    for (int k = 0; k < K; ++k) {
      const Lanes v = *reinterpret_cast<const Lanes*>(V + k * kSlab + i);
#pragma GCC unroll 4
      for (int j = 0; j < J; ++j) w[j] += v * c[k][j];
    }
    for (int j = 0; j < J; ++j) *reinterpret_cast<Lanes*>(W + j * kSlab + i) = w[j];
  }
}

template <class R, int J>
[[gnu::always_inline]] inline void dot_slab(const Slab& s) {
  const int whole = s.n_columns / kColumns * kColumns;
  const auto C = [&](int k, int j) { return s.C + (k * s.n_vectors + j) * R::kLanes; };
  for (int k = 0; k < whole; k += kColumns)
    for (int j = 0; j < s.n_vectors; j += J)
      dot_tile<R, kColumns, J>(s.V + k * kSlab, s.W + j * kSlab, C(k, j), s.n_vectors);
  for (int k = whole; k < s.n_columns; ++k)
    for (int j = 0; j < s.n_vectors; j += J)
      dot_tile<R, 1, J>(s.V + k * kSlab, s.W + j * kSlab, C(k, j), s.n_vectors);
}

template <class R, int J>
[[gnu::always_inline]] inline void add_slab(const Slab& s) {
  const int whole = s.n_columns / kColumns * kColumns;
  const auto C = [&](int k, int j) { return s.C + k * s.n_vectors + j; };
  for (int k = 0; k < whole; k += kColumns)
    for (int j = 0; j < s.n_vectors; j += J)
      add_tile<R, kColumns, J>(s.V + k * kSlab, s.W + j * kSlab, C(k, j), s.n_vectors);
  for (int k = whole; k < s.n_columns; ++k)
    for (int j = 0; j < s.n_vectors; j += J)
      add_tile<R, 1, J>(s.V + k * kSlab, s.W + j * kSlab, C(k, j), s.n_vectors);
}

struct Kernels {
  int lanes;
  void (*dot)(const Slab&);
  void (*add)(const Slab&);
};

void dot_portable(const Slab& s) { dot_slab<Register<16>, 2>(s); }
void add_portable(const Slab& s) { add_slab<Register<16>, 2>(s); }

#ifdef __x86_64__
[[gnu::target("avx2,fma")]] void dot_avx2(const Slab& s) { dot_slab<Register<32>, 2>(s); }
[[gnu::target("avx2,fma")]] void add_avx2(const Slab& s) { add_slab<Register<32>, 2>(s); }
[[gnu::target("avx512f")]] void dot_avx512(const Slab& s) { dot_slab<Register<64>, 4>(s); }
[[gnu::target("avx512f")]] void add_avx512(const Slab& s) { add_slab<Register<64>, 4>(s); }
#endif

Kernels kernels([[maybe_unused]] Instructions instructions) {
#ifdef __x86_64__
  if (instructions == Instructions::avx512) return {Register<64>::kLanes, dot_avx512, add_avx512};
  if (instructions == Instructions::avx2) return {Register<32>::kLanes, dot_avx2, add_avx2};
#endif
  return {Register<16>::kLanes, dot_portable, add_portable};
}

int padded(Eigen::Index n_vectors) { return (static_cast<int>(n_vectors) + kPad - 1) / kPad * kPad; }

// Rows of the slab in W, the rest zero.
void load(const Eigen::Ref<const Eigen::MatrixXd>& W, Eigen::Index slab, Eigen::MatrixXd& rows) {
  const Eigen::Index first = slab * kSlab, n = std::min(kSlab, W.rows() - first);
  rows.topLeftCorner(n, W.cols()) = W.middleRows(first, n);
  if (n < kSlab) rows.bottomRows(kSlab - n).setZero();
}

}  // namespace

TallBasis::TallBasis(Eigen::Index n_rows, int capacity, Instructions instructions)
    : n_rows_(n_rows),
      n_slabs_((n_rows + kSlab - 1) / kSlab),
      capacity_(capacity),
      instructions_(instructions),
      values_(new double[static_cast<std::size_t>(n_slabs_ * kSlab * capacity)]) {}

double* TallBasis::at(Eigen::Index slab, int column) const {
  return values_.get() + (slab * capacity_ + column) * kSlab;
}

void TallBasis::set(int first, const Eigen::Ref<const Eigen::MatrixXd>& Q) {
  Eigen::MatrixXd rows(kSlab, Q.cols());
  for (Eigen::Index slab = 0; slab < n_slabs_; ++slab) {
    load(Q, slab, rows);
    std::copy_n(rows.data(), rows.size(), at(slab, first));
  }
}

Eigen::MatrixXd TallBasis::get(int first, int n) const {
  Eigen::MatrixXd Q(n_rows_, n);
  for (Eigen::Index slab = 0; slab < n_slabs_; ++slab) {
    const Eigen::Index row = slab * kSlab, rows = std::min(kSlab, n_rows_ - row);
    Q.middleRows(row, rows) = Eigen::Map<const Eigen::MatrixXd>(at(slab, first), kSlab, n).topRows(rows);
  }
  return Q;
}

Eigen::MatrixXd TallBasis::dot(int n, const Eigen::Ref<const Eigen::MatrixXd>& W) const {
  const Kernels kernel = kernels(instructions_);
  const int n_vectors = padded(W.cols());
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(kSlab, n_vectors);
  Eigen::MatrixXd lanes = Eigen::MatrixXd::Zero(kernel.lanes, static_cast<Eigen::Index>(n) * n_vectors);
  for (Eigen::Index slab = 0; slab < n_slabs_; ++slab) {
    load(W, slab, rows);
    kernel.dot({at(slab, 0), rows.data(), lanes.data(), n, n_vectors});
  }
  const Eigen::VectorXd sums = lanes.colwise().sum();
  return sums.reshaped(n_vectors, n).transpose().leftCols(W.cols());
}

void TallBasis::add_product(int first, const Eigen::Ref<const Eigen::MatrixXd>& C,
                            Eigen::Ref<Eigen::MatrixXd> Y) const {
  const Kernels kernel = kernels(instructions_);
  const int n_vectors = padded(Y.cols());
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(kSlab, n_vectors);
  Eigen::MatrixXd coefficients = Eigen::MatrixXd::Zero(n_vectors, C.rows());
  coefficients.topRows(C.cols()) = C.transpose();
  for (Eigen::Index slab = 0; slab * kSlab < Y.rows(); ++slab) {
    load(Y, slab, rows);
    kernel.add({at(slab, first), rows.data(), coefficients.data(), static_cast<int>(C.rows()), n_vectors});
    const Eigen::Index row = slab * kSlab, n = std::min(kSlab, Y.rows() - row);
    Y.middleRows(row, n) = rows.topLeftCorner(n, Y.cols());
  }
}

}  // namespace elastogear::reduction
