// Top-down build by the surface-area heuristic: of all planes normal to a k-DOP direction (binned), split
// where area(left) n_left + area(right) n_right is least.

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>

#include "elastogear/contact/bvh.h"

namespace elastogear::contact {
namespace {

constexpr int kBins = 16;  // at most; no more than faces

struct Builder {
  const Directions& B;
  std::vector<Kdop> dop;   // per face
  std::vector<int> order;  // faces; each node owns a range
  Bvh bvh;

  double centre(int face, int i) const { return 0.5 * (dop[face].lo[i] + dop[face].hi[i]); }
};

struct Split {
  int direction = -1;
  int bins = kBins;
  double lo = 0, scale = 0;  // bin = (centre - lo) * scale
  int bin = 0;               // bins below go left
  double cost = std::numeric_limits<double>::infinity();
};

int bin_of(double centre, const Split& s) {
  return std::clamp(static_cast<int>((centre - s.lo) * s.scale), 0, s.bins - 1);
}

struct Bin {
  Kdop dop;
  int count = 0;
};
using Bins = std::array<Bin, kBins>;

Bins fill_bins(const Builder& b, std::span<const int> faces, const Split& s) {
  Bins bins;
  std::fill_n(bins.begin(), s.bins, Bin{empty_kdop(b.bvh.k), 0});
  for (int f : faces) {
    Bin& bin = bins[bin_of(b.centre(f, s.direction), s)];
    merge(bin.dop, b.dop[f]);
    ++bin.count;
  }
  return bins;
}

// Best plane among the bins' borders of one direction. Beside an empty bin nothing changes.
Split sweep(const Bins& bins, Split s) {
  std::array<double, kBins> right_cost{};
  Kdop dop = bins[s.bins - 1].dop;
  int count = 0;
  double cost = 0;
  for (int i = s.bins - 1; i > 0; --i) {
    if (bins[i].count > 0) {
      merge(dop, bins[i].dop);
      count += bins[i].count;
      cost = area(dop) * count;
    }
    right_cost[i] = cost;
  }
  dop = bins.front().dop;
  count = 0;
  for (int i = 1; i < s.bins; ++i) {
    if (bins[i - 1].count == 0) continue;
    merge(dop, bins[i - 1].dop);
    count += bins[i - 1].count;
    cost = area(dop) * count + right_cost[i];
    if (cost < s.cost) s.cost = cost, s.bin = i;
  }
  return s;
}

Split best_split(const Builder& b, std::span<const int> faces) {
  Split best;
  for (int i = 0; i < b.B.n; ++i) {
    double lo = b.centre(faces[0], i), hi = lo;
    for (int f : faces) lo = std::min(lo, b.centre(f, i)), hi = std::max(hi, b.centre(f, i));
    if (!(hi > lo)) continue;
    Split s;
    s.bins = std::min(kBins, static_cast<int>(faces.size()));
    s.direction = i, s.lo = lo, s.scale = s.bins / (hi - lo);
    s = sweep(fill_bins(b, faces, s), s);
    if (s.cost < best.cost) best = s;
  }
  return best;
}

// Sorts the range so that the left child's faces come first; returns their number, at least 1.
int partition(Builder& b, std::span<int> faces) {
  const Split s = best_split(b, faces);
  const int half = static_cast<int>(faces.size()) / 2;
  if (s.direction < 0) return half;  // all centres coincide
  const auto middle = std::stable_partition(
      faces.begin(), faces.end(), [&](int f) { return bin_of(b.centre(f, s.direction), s) < s.bin; });
  const int left = static_cast<int>(middle - faces.begin());
  return left == 0 || left == static_cast<int>(faces.size()) ? half : left;
}

struct Range {
  int node, begin, end;
};

void grow(Builder& b) {
  b.bvh.child.push_back(0);
  std::vector<Range> tasks{{0, 0, static_cast<int>(b.order.size())}};
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const auto [node, begin, end] = tasks[i];
    if (end - begin == 1) {
      b.bvh.child[node] = -1 - b.order[begin];
      continue;
    }
    const int middle = begin + partition(b, std::span(b.order).subspan(begin, end - begin));
    const int first = b.bvh.n_nodes();
    b.bvh.child[node] = first;
    b.bvh.child.resize(first + 2);
    tasks.push_back({first, begin, middle});
    tasks.push_back({first + 1, middle, end});
  }
}

}  // namespace

Bvh build(const Eigen::Matrix3Xd& X, const Eigen::Matrix4Xi& face, int k) {
  Builder b{directions(k), {}, std::vector<int>(face.cols()), {}};
  b.bvh.k = k;
  std::iota(b.order.begin(), b.order.end(), 0);
  for (Eigen::Index f = 0; f < face.cols(); ++f) b.dop.push_back(tight_kdop(k, X(Eigen::all, face.col(f))));
  grow(b);
  RefitMemory work;
  refit(b.bvh, X, face, 0, work);
  return std::move(b.bvh);
}

}  // namespace elastogear::contact
