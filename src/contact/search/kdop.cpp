#include "elastogear/contact/kdop.h"

#include <algorithm>
#include <limits>
#include <span>

#include "elastogear/base/error.h"

namespace elastogear::contact {
namespace {

using Triple = std::array<double, 3>;
constexpr std::array<Triple, 3> axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
constexpr std::array<Triple, 6> edges{{{1, 1, 0}, {1, 0, 1}, {0, 1, 1}, {1, -1, 0}, {1, 0, -1}, {0, 1, -1}}};
constexpr std::array<Triple, 4> corners{{{1, 1, -1}, {1, -1, 1}, {-1, 1, 1}, {1, 1, 1}}};

void append(Directions& B, std::span<const Triple> more) {
  for (const auto& [x, y, z] : more) {
    B.x[B.n] = x, B.y[B.n] = y, B.z[B.n] = z;
    B.norm[B.n++] = Eigen::Vector3d(x, y, z).norm();
  }
}

Directions make_directions(bool with_edges, int n_corners) {
  Directions B;
  append(B, axes);
  if (with_edges) append(B, edges);
  append(B, std::span(corners).first(n_corners));
  return B;
}

}  // namespace

const Directions& directions(int k) {
  static const Directions k6 = make_directions(false, 0), k14 = make_directions(false, 4),
                          k18 = make_directions(true, 0), k24 = make_directions(true, 3),
                          k26 = make_directions(true, 4);
  switch (k) {
    case 6:
      return k6;
    case 14:
      return k14;
    case 18:
      return k18;
    case 24:
      return k24;
    case 26:
      return k26;
    default:
      fail("contact: k-DOP with k = ", k, ", allowed are 6, 14, 18, 24, 26");
  }
}

Kdop empty_kdop(int k) {
  Kdop dop{k, {}, {}};
  dop.lo.fill(std::numeric_limits<double>::infinity());
  dop.hi.fill(-std::numeric_limits<double>::infinity());
  return dop;
}

Kdop tight_kdop(int k, const Eigen::Ref<const Eigen::Matrix3Xd>& points) {
  const Directions& B = directions(k);
  Kdop dop = empty_kdop(k);
  for (const auto& p : points.colwise())
    for (int i = 0; i < B.n; ++i) {
      const double d = B.x[i] * p.x() + B.y[i] * p.y() + B.z[i] * p.z();
      dop.lo[i] = std::min(dop.lo[i], d);
      dop.hi[i] = std::max(dop.hi[i], d);
    }
  return dop;
}

void merge(Kdop& into, const Kdop& other) {
  for (int i = 0; i < into.k / 2; ++i) {
    into.lo[i] = std::min(into.lo[i], other.lo[i]);
    into.hi[i] = std::max(into.hi[i], other.hi[i]);
  }
}

bool overlap(const Kdop& a, const Kdop& b) {
  for (int i = 0; i < a.k / 2; ++i)
    if (a.lo[i] > b.hi[i] || a.hi[i] < b.lo[i]) return false;
  return true;
}

Kdop inflated(Kdop dop, double margin) {
  const Directions& B = directions(dop.k);
  for (int i = 0; i < B.n; ++i) {
    dop.lo[i] -= margin * B.norm[i];
    dop.hi[i] += margin * B.norm[i];
  }
  return dop;
}

double area(const Kdop& dop) {
  const Directions& B = directions(dop.k);
  if (dop.lo[0] > dop.hi[0]) return 0;
  double sum = 0, squares = 0;
  for (int i = 0; i < B.n; ++i) {
    const double w = (dop.hi[i] - dop.lo[i]) / B.norm[i];
    sum += w;
    squares += w * w;
  }
  return sum * sum - squares;
}

}  // namespace elastogear::contact
