// Boxes of a tree from the moved surface, leaves first.

#include <algorithm>
#include <limits>

#include "contact/search/padded_half.h"
#include "elastogear/contact/bvh.h"

namespace elastogear::contact {
namespace {

constexpr int kBlock = 256;  // nodes whose boxes fit into the first cache

template <int kBytes>
struct Register {
  typedef float Lanes __attribute__((vector_size(kBytes), aligned(alignof(float)), may_alias));
  static constexpr int kLanes = kBytes / static_cast<int>(sizeof(float));
  [[gnu::always_inline]] static const Lanes& at(const float* p) { return *reinterpret_cast<const Lanes*>(p); }
};

using PointLanes = Register<16>::Lanes;
typedef double Double4 __attribute__((vector_size(32), aligned(alignof(double)), may_alias));

// Stores x, y, z in float and what comes after them; their absolute values enter the largest ones.
[[gnu::always_inline]] inline void round_point(const double* x, float* point, PointLanes& largest) {
  const PointLanes p = __builtin_convertvector(*reinterpret_cast<const Double4*>(x), PointLanes);
  *reinterpret_cast<PointLanes*>(point) = p;
  const PointLanes size = p < -p ? -p : p;
  largest = largest < size ? size : largest;
}

// Four floats per point, of which the last means nothing. Returns a bound of |x| + |y| + |z| of all points.
[[gnu::always_inline]] inline float round_points(const Eigen::Matrix3Xd& x, float* points) {
  PointLanes largest = {};
  const Eigen::Index last = x.cols() - 1;
  for (Eigen::Index i = 0; i < last; ++i) round_point(x.data() + 3 * i, points + 4 * i, largest);
  const double end[4] = {x(0, last), x(1, last), x(2, last), 0};
  round_point(end, points + 4 * last, largest);
  return largest[0] + largest[1] + largest[2];
}

// The directions B_i, filled up to L, a multiple of a register, and how far boxes are wider than their
// points: products are exact, so that rounding the point, two sums and the last difference err by 4 ulp of
// |p|_1 and one of the width, but for squares of an ulp. 5 and 4 are taken, besides 4 for the rounding of the
// width itself, and the least normal number for denormals. Infinite in the padding.
template <int L>
struct LanePlanes {
  alignas(64) float x[L] = {}, y[L] = {}, z[L] = {}, width[L];

  LanePlanes(const Directions& B, double margin, float size) {
    std::fill_n(width, L, std::numeric_limits<float>::infinity());
    for (int i = 0; i < B.n; ++i) {
      x[i] = static_cast<float>(B.x[i]);
      y[i] = static_cast<float>(B.y[i]);
      z[i] = static_cast<float>(B.z[i]);
      const auto w = static_cast<float>(margin * B.norm[i] + 5 * kUlp * static_cast<double>(size));
      width[i] = w * (1 + 8 * kUlp) + std::numeric_limits<float>::min();
    }
  }
};

template <class R, int H, int L>
[[gnu::always_inline]] inline void leaf_box(const LanePlanes<L>& B, const float* points, const int* corner,
                                            float* box) {
  using Lanes = typename R::Lanes;
  const float* p[4];
  for (int c = 0; c < 4; ++c) p[c] = points + 4 * static_cast<std::size_t>(corner[c]);
  alignas(64) float lo[L], minus_hi[L];
#pragma GCC unroll 4
  for (int i = 0; i < L; i += R::kLanes) {
    const Lanes x = R::at(B.x + i), y = R::at(B.y + i), z = R::at(B.z + i), width = R::at(B.width + i);
    Lanes least = x * p[0][0] + y * p[0][1] + z * p[0][2], most = least;
#pragma GCC unroll 4
    for (int c = 1; c < 4; ++c) {
      const Lanes d = x * p[c][0] + y * p[c][1] + z * p[c][2];
      least = d < least ? d : least;
      most = most < d ? d : most;
    }
    *reinterpret_cast<Lanes*>(lo + i) = least - width;
    *reinterpret_cast<Lanes*>(minus_hi + i) = -most - width;
  }
  std::copy_n(lo, H, box);
  std::copy_n(minus_hi, H, box + H);
}

template <class R, int N>
[[gnu::always_inline]] inline void parent_box(const float* children, float* box) {
  using Lanes = typename R::Lanes;
#pragma GCC unroll 8
  for (int i = 0; i < N; i += R::kLanes) {
    const Lanes a = R::at(children + i), b = R::at(children + N + i);
    *reinterpret_cast<Lanes*>(box + i) = b < a ? b : a;
  }
}

struct RefitTask {
  Bvh& bvh;
  const Eigen::Matrix3Xd& x;
  const Eigen::Matrix4Xi& face;
  double margin;
  float* points;
};

// Block by block, in each the leaves first: no branch has to be foreseen for a node. Registers for leaves and
// for parents.
template <class R_leaf, class R_parent, int H>
[[gnu::always_inline]] inline void all_boxes(const RefitTask& t) {
  constexpr int N = 2 * H, L = (H + R_leaf::kLanes - 1) / R_leaf::kLanes * R_leaf::kLanes;
  const float size = round_points(t.x, t.points);
  const LanePlanes<L> B(directions(t.bvh.k), t.margin, size);
  const int* child = t.bvh.child.data();
  float* box = t.bvh.box.data();
  for (int end = t.bvh.n_nodes(); end > 0; end -= kBlock) {
    int leaf[kBlock], inner[kBlock], n_leaves = 0, n_inner = 0;
    for (int node = end - 1; node >= std::max(0, end - kBlock); --node) {
      leaf[n_leaves] = inner[n_inner] = node;
      n_leaves += child[node] < 0;
      n_inner += child[node] >= 0;
    }
    for (int i = 0; i < n_leaves; ++i)
      leaf_box<R_leaf, H>(B, t.points, t.face.col(-1 - child[leaf[i]]).data(),
                          box + N * std::size_t(leaf[i]));
    for (int i = 0; i < n_inner; ++i)
      parent_box<R_parent, N>(box + N * std::size_t(child[inner[i]]), box + N * std::size_t(inner[i]));
  }
}

template <int H>
void boxes_portable(const RefitTask& t) {
  all_boxes<Register<16>, Register<16>, H>(t);
}

#ifdef __x86_64__
template <int H>
[[gnu::target("avx2,fma")]] void boxes_avx2(const RefitTask& t) {
  all_boxes<Register<32>, Register<32>, H>(t);
}
template <int H>
[[gnu::target("avx512f")]] void boxes_avx512(const RefitTask& t) {
  all_boxes<Register<64>, Register<32>, H>(t);
}
#endif

template <int H>
void boxes(const RefitTask& t, [[maybe_unused]] Instructions instructions) {
#ifdef __x86_64__
  if (instructions == Instructions::avx512) return boxes_avx512<H>(t);
  if (instructions == Instructions::avx2) return boxes_avx2<H>(t);
#endif
  boxes_portable<H>(t);
}

}  // namespace

void refit(Bvh& bvh, const Eigen::Matrix3Xd& x, const Eigen::Matrix4Xi& face, double margin,
           RefitMemory& work) {
  work.points.resize(4 * x.cols());
  with_half(bvh.k, [&](auto half) {
    bvh.box.resize(static_cast<std::size_t>(2) * half * bvh.n_nodes());
    boxes<half>({bvh, x, face, margin, work.points.data()}, work.instructions);
  });
}

}  // namespace elastogear::contact
