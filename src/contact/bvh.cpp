#include "elastogear/contact/bvh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace elastogear::contact {
namespace {

// Calls f with k as a compile-time constant: loops over the directions then have a fixed length.
template <class F>
void with_size(int k, F f) {
  switch (k) {
    case 6:
      return f(std::integral_constant<int, 6>());
    case 14:
      return f(std::integral_constant<int, 14>());
    case 18:
      return f(std::integral_constant<int, 18>());
    case 24:
      return f(std::integral_constant<int, 24>());
    default:
      return f(std::integral_constant<int, 26>());
  }
}

// A float not above d. The step of 2 ulp covers the rounding of d and of the subtraction; the least normal
// number covers denormals.
float round_down(double d) {
  const float f = static_cast<float>(d);
  return f - (std::abs(f) * 2 * std::numeric_limits<float>::epsilon() + std::numeric_limits<float>::min());
}

template <int K>
void point_box(const Directions& B, const double* p, const double* margin, float* box) {
  constexpr int h = K / 2;
  for (int i = 0; i < h; ++i) {
    const double d = B.x[i] * p[0] + B.y[i] * p[1] + B.z[i] * p[2];
    box[i] = round_down(d - margin[i]);
    box[h + i] = round_down(-d - margin[i]);
  }
}

template <int K>
void shrink_to_min(float* into, const float* other) {
  for (int i = 0; i < K; ++i) into[i] = other[i] < into[i] ? other[i] : into[i];
}

template <int K>
bool boxes_overlap(const float* a, const float* b) {
  int apart = 0;
  for (int i = 0; i < K / 2; ++i) apart |= (a[i] > -b[K / 2 + i]) | (b[i] > -a[K / 2 + i]);
  return !apart;
}

template <int K>
void refit_boxes(Bvh& bvh, const Eigen::Matrix3Xd& x, const Eigen::Matrix4Xi& face, double margin,
                 std::vector<float>& work) {
  constexpr std::size_t k = K;
  const Directions& B = directions(K);
  std::array<double, K / 2> margins;
  for (int i = 0; i < K / 2; ++i) margins[i] = margin * B.norm[i];
  work.resize(k * x.cols());
  for (Eigen::Index i = 0; i < x.cols(); ++i) point_box<K>(B, x.col(i).data(), margins.data(), &work[k * i]);
  bvh.box.resize(k * bvh.n_nodes());
  for (int node = bvh.n_nodes() - 1; node >= 0; --node) {
    float* into = &bvh.box[k * node];
    if (bvh.is_leaf(node)) {
      const auto corner = face.col(bvh.face(node));
      std::copy_n(&work[k * corner[0]], k, into);
      for (int c = 1; c < 4; ++c) shrink_to_min<K>(into, &work[k * corner[c]]);
    } else {
      std::copy_n(&bvh.box[k * bvh.child[node]], k, into);
      shrink_to_min<K>(into, &bvh.box[k * (bvh.child[node] + 1)]);
    }
  }
}

template <int K>
class Descent {
 public:
  Descent(const Bvh& a, const Bvh& b, const std::function<void(int)>& visit_a, std::vector<NodePair>& front)
      : a_(a), b_(b), visit_a_(visit_a), front_(front) {}

  void run(std::vector<NodePair>& faces) {
    front_.clear();
    if (visit_a_) visit_a_(0);
    test(0, 0);
    for (std::size_t i = 0; i < front_.size(); ++i) {
      const auto [node_a, node_b] = front_[i];
      if (a_.is_leaf(node_a) && b_.is_leaf(node_b))
        faces.push_back({a_.face(node_a), b_.face(node_b)});
      else
        expand(node_a, node_b);
    }
  }

 private:
  void test(int node_a, int node_b) {
    if (boxes_overlap<K>(&a_.box[static_cast<std::size_t>(node_a) * K],
                         &b_.box[static_cast<std::size_t>(node_b) * K]))
      front_.push_back({node_a, node_b});
  }

  void expand(int node_a, int node_b) {
    const int n_a = a_.is_leaf(node_a) ? 1 : 2, n_b = b_.is_leaf(node_b) ? 1 : 2;
    const int first_a = n_a == 1 ? node_a : a_.child[node_a], first_b = n_b == 1 ? node_b : b_.child[node_b];
    if (n_a == 2 && visit_a_) visit_a_(first_a);
    for (int i = 0; i < n_a; ++i)
      for (int j = 0; j < n_b; ++j) test(first_a + i, first_b + j);
  }

  const Bvh& a_;
  const Bvh& b_;
  const std::function<void(int)>& visit_a_;
  std::vector<NodePair>& front_;
};

}  // namespace

void refit(Bvh& bvh, const Eigen::Matrix3Xd& x, const Eigen::Matrix4Xi& face, double margin,
           std::vector<float>& work) {
  with_size(bvh.k, [&](auto k) { refit_boxes<k>(bvh, x, face, margin, work); });
}

Kdop box(const Bvh& bvh, int node) {
  Kdop dop{bvh.k, {}, {}};
  const float* stored = &bvh.box[static_cast<std::size_t>(bvh.k) * node];
  for (int i = 0; i < bvh.k / 2; ++i) {
    dop.lo[i] = stored[i];
    dop.hi[i] = -static_cast<double>(stored[bvh.k / 2 + i]);
  }
  return dop;
}

void set_box(Bvh& bvh, int node, const Kdop& dop) {
  float* stored = &bvh.box[static_cast<std::size_t>(bvh.k) * node];
  for (int i = 0; i < bvh.k / 2; ++i) {
    stored[i] = round_down(dop.lo[i]);
    stored[bvh.k / 2 + i] = round_down(-dop.hi[i]);
  }
}

void overlapping_faces(const Bvh& a, const Bvh& b, const std::function<void(int)>& visit_a,
                       std::vector<NodePair>& work, std::vector<NodePair>& pairs) {
  pairs.clear();
  with_size(a.k, [&](auto k) { Descent<k>(a, b, visit_a, work).run(pairs); });
}

std::vector<int> nodes_at_level(const Bvh& bvh, int level) {
  std::vector<int> nodes{0};
  for (int l = 0; l < level; ++l) {
    std::vector<int> next;
    for (int node : nodes) {
      if (bvh.is_leaf(node)) {
        next.push_back(node);
      } else {
        next.push_back(bvh.child[node]);
        next.push_back(bvh.child[node] + 1);
      }
    }
    nodes = std::move(next);
  }
  return nodes;
}

int depth(const Bvh& bvh) {
  std::vector<int> below(bvh.n_nodes(), 0);
  for (int node = bvh.n_nodes() - 1; node >= 0; --node)
    if (!bvh.is_leaf(node)) {
      const int first = bvh.child[node];
      below[node] = 1 + std::max(below[first], below[first + 1]);
    }
  return below[0];
}

}  // namespace elastogear::contact
