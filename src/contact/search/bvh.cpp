#include "elastogear/contact/bvh.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/search/padded_half.h"

namespace elastogear::contact {
namespace {

using Float4 = float __attribute__((vector_size(16)));
using Int4 = int __attribute__((vector_size(16)));

Float4 load(const float* p) {
  Float4 v;
  __builtin_memcpy(&v, p, sizeof v);
  return v;
}

// A float not above d. The step of 2 ulp covers the rounding of d and of the subtraction; the least normal
// number covers denormals.
float round_down(double d) {
  const float f = static_cast<float>(d);
  return f - (std::abs(f) * 4 * kUlp + std::numeric_limits<float>::min());
}

template <int H>
bool boxes_overlap(const float* a, const float* b) {
  Int4 apart = {};
  for (int i = 0; i < H; i += 4) apart |= (load(a + i) > -load(b + H + i)) | (load(b + i) > -load(a + H + i));
  long long half[2];
  __builtin_memcpy(half, &apart, sizeof apart);
  return (half[0] | half[1]) == 0;
}

// Breadth-first descent, level by level: every pair of a level either is a pair of leaves or is replaced by
// the overlapping ones of its up to four pairs of children.
template <int H>
class Descent {
 public:
  Descent(const Bvh& a, const Bvh& b, const std::function<void(int)>& visit_a)
      : a_(a), b_(b), visit_a_(visit_a) {}

  void run(std::vector<NodePair>& front, std::vector<NodePair>& next, std::vector<NodePair>& faces) {
    if (visit_a_) visit_a_(0);
    front.resize(1);
    if (add(0, 0, front.data()) == front.data()) return;
    while (!front.empty()) {
      next.resize(4 * front.size());
      NodePair* end = next.data();
      for (const auto& [node_a, node_b] : front) {
        if (a_.is_leaf(node_a) && b_.is_leaf(node_b))
          faces.push_back({a_.face(node_a), b_.face(node_b)});
        else
          end = expand(node_a, node_b, end);
      }
      next.resize(end - next.data());
      front.swap(next);
    }
  }

 private:
  NodePair* add(int node_a, int node_b, NodePair* end) const {
    *end = {node_a, node_b};
    return end + boxes_overlap<H>(&a_.box[static_cast<std::size_t>(node_a) * 2 * H],
                                  &b_.box[static_cast<std::size_t>(node_b) * 2 * H]);
  }

  NodePair* expand(int node_a, int node_b, NodePair* end) const {
    const int n_a = a_.is_leaf(node_a) ? 1 : 2, n_b = b_.is_leaf(node_b) ? 1 : 2;
    const int first_a = n_a == 1 ? node_a : a_.child[node_a], first_b = n_b == 1 ? node_b : b_.child[node_b];
    if (n_a == 2 && visit_a_) visit_a_(first_a);
    for (int i = 0; i < n_a; ++i)
      for (int j = 0; j < n_b; ++j) end = add(first_a + i, first_b + j, end);
    return end;
  }

  const Bvh& a_;
  const Bvh& b_;
  const std::function<void(int)>& visit_a_;
};

}  // namespace

Kdop box(const Bvh& bvh, int node) {
  Kdop dop{bvh.k, {}, {}};
  const int half = padded_half(bvh.k);
  const float* stored = &bvh.box[static_cast<std::size_t>(2) * half * node];
  for (int i = 0; i < bvh.k / 2; ++i) {
    dop.lo[i] = stored[i];
    dop.hi[i] = -static_cast<double>(stored[half + i]);
  }
  return dop;
}

void set_box(Bvh& bvh, int node, const Kdop& dop) {
  const int half = padded_half(bvh.k);
  float* stored = &bvh.box[static_cast<std::size_t>(2) * half * node];
  for (int i = 0; i < bvh.k / 2; ++i) {
    stored[i] = round_down(dop.lo[i]);
    stored[half + i] = round_down(-dop.hi[i]);
  }
}

void overlapping_faces(const Bvh& a, const Bvh& b, const std::function<void(int)>& visit_a,
                       DescentMemory& work, std::vector<NodePair>& pairs) {
  pairs.clear();
  with_half(a.k, [&](auto half) { Descent<half>(a, b, visit_a).run(work.front, work.next, pairs); });
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
