#pragma once
// Estimates of the least value of a function along a side or on a quadrilateral from its values and slopes at
// the corners, by cubic Hermite polynomials.

#include <Eigen/Core>
#include <array>

namespace elastogear::contact {

struct LeastOnSide {
  double value, s;
};
/// Of the cubic with these values and slopes at s = 0 and 1, whose first slope is negative, the second
/// positive.
LeastOnSide least_of_cubic(const std::array<double, 2>& value, const std::array<double, 2>& slope);

/// Values, and slopes with (u, v), at the corners of a quadrilateral (contact/face.h).
struct FaceCorners {
  Eigen::Vector4d value;
  Eigen::Matrix<double, 2, 4> slope;
};

/// Below the values of every convex function with these corners: its tangent planes. A corner that is not
/// known has the value -infinity.
double lower_bound(const FaceCorners& corners);

struct LeastOnFace {
  double value;
  Eigen::Vector2d at;
  double beyond;  ///< of (u, v), how far beyond the face the function falls on as a parabola; 0 within it
};
/// Of the bicubic without twists, among 7 x 7 points.
LeastOnFace least_of_bicubic(const FaceCorners& corners);

}  // namespace elastogear::contact
