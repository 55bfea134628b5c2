#pragma once
// Displacements of an elastic half-space by pressures on strips of a line of contact (docs/theory, section
// 6.18). All are means of the inverse distance 1/r, in 1/m; (1 - nu^2) / (pi E) times that is m/N.

#include <limits>
#include <vector>

#include <Eigen/Core>

namespace elastogear::contact {

/// A piece of a line of contact: places along it, m, from < to.
struct Strip {
  double from, to;

  double length() const { return to - from; }
  double centre() const { return (from + to) / 2; }
  bool operator==(const Strip&) const = default;
};

/// Where the face of one body ends, m along the line of contact. Pressures have an image beyond each end that
/// is finite. Eq. (6.42).
struct FreeEnds {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  double share =
      1;  ///< -, of an image; 1: the mirror of J. M. de Mul, J. J. Kalker and B. Fredriksson (1986)
};

/// The images of a strip beyond the finite ends: none, one or two. Eq. (6.42).
std::vector<Strip> images(const Strip& strip, const FreeEnds& ends);

/// 1/m: of an even pressure on b of the half width q, along the centre line of a. q = 0: of a line load, for
/// strips that do not overlap. Eq. (6.40).
double line_inverse_distance(const Strip& a, const Strip& b, double q);

/// n x n, 1/m: the same among strips of one line, with images. Symmetric and positive definite for q > 0.
Eigen::MatrixXd line_kernel(const std::vector<Strip>& strips, double q, const FreeEnds& ends);

}  // namespace elastogear::contact
