#pragma once
// Discrete oriented polytopes: convex bodies bounded by k planes of fixed orientation (docs/theory,
// section 5). k/2 directions B_i with entries 0 and +-1; a k-DOP is one interval per direction.

#include <Eigen/Core>
#include <array>
#include <vector>

namespace elastogear::contact {

inline constexpr int kMostDirections = 26;

/// Components of the k/2 directions B_i: axes first, then edge and corner directions of the cube.
/// k = 6: axes; 14: and corners; 18: and edges; 24: edges and three corners; 26: all.
struct Directions {
  int n = 0;  ///< k/2
  std::array<double, kMostDirections / 2> x{}, y{}, z{}, norm{};

  Eigen::Vector3d operator[](int i) const { return {x[i], y[i], z[i]}; }
};

/// Throws Error unless k is 6, 14, 18, 24 or 26.
const Directions& directions(int k);

/// lo_i <= B_i . x <= hi_i. The empty k-DOP has lo = +inf, hi = -inf.
struct Kdop {
  int k = 0;
  std::array<double, kMostDirections / 2> lo, hi;
};

Kdop empty_kdop(int k);

/// Smallest k-DOP that holds all points (columns, m), Eq. (5.1).
Kdop tight_kdop(int k, const Eigen::Ref<const Eigen::Matrix3Xd>& points);

void merge(Kdop& into, const Kdop& other);

/// Eq. (5.2): false when an interval of one lies beyond the other's. Touching counts as overlap.
bool overlap(const Kdop& a, const Kdop& b);

/// Moves every plane outwards by `margin` (m).
Kdop inflated(Kdop dop, double margin);

/// sum over i != j of w_i w_j with the widths w_i: the surface area of a box when k = 6, and a measure of the
/// same kind for k > 6. 0 for the empty k-DOP.
double area(const Kdop& dop);

/// Corner points and polygonal faces, for pictures. Faces are counter-clockwise from outside; planes that
/// touch in less than an area have no face.
struct Polyhedron {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::vector<int>> faces;
};
Polyhedron polyhedron(const Kdop& dop);

}  // namespace elastogear::contact
