#include "contact/search/realign.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace elastogear::contact {
namespace {

struct Basis {
  std::array<int, 3> axis;
  Eigen::Matrix3d inverse;
};

// All triples of directions that span space.
std::vector<Basis> bases(int k) {
  const Directions& B = directions(k);
  std::vector<Basis> result;
  for (int a = 0; a < B.n; ++a)
    for (int b = a + 1; b < B.n; ++b)
      for (int c = b + 1; c < B.n; ++c) {
        Eigen::Matrix3d A;
        A << B[a], B[b], B[c];
        const double determinant = A.determinant();  // an integer
        if (std::abs(determinant) > 0.5) result.push_back({{a, b, c}, A.inverse()});
      }
  return result;
}

const std::vector<Basis>& cached_bases(int k) {
  static const std::array<std::vector<Basis>, 5> all{bases(6), bases(14), bases(18), bases(24), bases(26)};
  switch (k) {
    case 6:
      return all[0];
    case 14:
      return all[1];
    case 18:
      return all[2];
    case 24:
      return all[3];
    default:
      return all[4];
  }
}

struct Ranked {
  double size;  // sum |w_j| |B_j|: the bound for a ball
  Combination combination;
};

std::vector<Ranked> combinations_of(int k, const Eigen::Vector3d& u) {
  const Directions& B = directions(k);
  std::vector<Ranked> result;
  for (const Basis& basis : cached_bases(k)) {
    const Eigen::Vector3d w = basis.inverse * u;
    Ranked r{0, {basis.axis, {w[0], w[1], w[2]}}};
    for (int j = 0; j < 3; ++j) r.size += std::abs(w[j]) * B.norm[basis.axis[j]];
    result.push_back(r);
  }
  return result;
}

// Adds the interval of sum_j w_j B_j . x, x in dop; returns its roundoff. docs/theory, Eq. (5.3).
double interval(const Kdop& dop, const Combination& c, double& lo, double& hi) {
  double size = 0;
  for (int j = 0; j < 3; ++j) {
    const double w = c.weight[j], at_lo = w * dop.lo[c.axis[j]], at_hi = w * dop.hi[c.axis[j]];
    lo += std::min(at_lo, at_hi);
    hi += std::max(at_lo, at_hi);
    size += std::max(std::abs(at_lo), std::abs(at_hi));
  }
  const double operations = 32;
  return operations * std::numeric_limits<double>::epsilon() * size;
}

}  // namespace

Realignment realignment(int k, const Eigen::Matrix3d& R, const Eigen::Vector3d& r, int per_direction) {
  const Directions& B = directions(k);
  Realignment motion{k, r, std::min<int>(per_direction, static_cast<int>(cached_bases(k).size())), {}};
  for (int i = 0; i < B.n; ++i) {
    auto ranked = combinations_of(k, R.transpose() * B[i]);
    std::partial_sort(ranked.begin(), ranked.begin() + motion.per_direction, ranked.end(),
                      [](const Ranked& a, const Ranked& b) { return a.size < b.size; });
    for (int j = 0; j < motion.per_direction; ++j) motion.combinations.push_back(ranked[j].combination);
  }
  return motion;
}

Kdop realigned(const Kdop& dop, const Realignment& motion) {
  const Directions& B = directions(dop.k);
  Kdop result{dop.k, {}, {}};
  const Combination* c = motion.combinations.data();
  for (int i = 0; i < B.n; ++i) {
    const double shift = B[i].dot(motion.r);
    result.lo[i] = -std::numeric_limits<double>::infinity();
    result.hi[i] = std::numeric_limits<double>::infinity();
    for (int j = 0; j < motion.per_direction; ++j, ++c) {
      double lo = shift, hi = shift;
      const double slack = interval(dop, *c, lo, hi) + std::abs(shift) * 1e-15;
      result.lo[i] = std::max(result.lo[i], lo - slack);
      result.hi[i] = std::min(result.hi[i], hi + slack);
    }
  }
  return result;
}

}  // namespace elastogear::contact
