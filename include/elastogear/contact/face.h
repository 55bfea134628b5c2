#pragma once
// One bilinear quadrilateral or plane triangle: interpolation, normals, and its extensions at the surface
// boundary (docs/theory, section 6). Side i runs from corner i to corner i+1.

#include <Eigen/Core>
#include <array>

namespace elastogear::contact {

/// Local coordinates (u, v): on quadrilaterals xi, eta of Eq. (6.1) in [-1, 1]; on triangles the weights of
/// the second and third corner.
struct Face {
  std::array<Eigen::Vector3d, 4> x;   ///< m, corners, counter-clockwise from outside
  int sides = 4;                      ///< 4, or 3 (x[3] unused)
  std::array<double, 4> extension{};  ///< per side, part of the face's length it is moved outwards; 0: a
                                      ///< shared edge, > 0: a surface boundary
};

/// Interpolation functions N_i, Eq. (6.1), and their derivatives with respect to (u, v).
struct Shape {
  Eigen::Vector4d N, N_u, N_v, N_uv;
};
Shape shape(int sides, double u, double v);

/// A function of (u, v) and its derivatives.
struct FaceFunction {
  double f = 0;
  Eigen::Vector2d f_a = Eigen::Vector2d::Zero();
  Eigen::Matrix2d f_ab = Eigen::Matrix2d::Zero();
};

/// sum_i weight_i x_i, the point x of Eq. (6.1) when the weights are N_i.
Eigen::Vector3d combine(const Face& face, const Eigen::Vector4d& weight);

/// Local coordinates of the point at s (0 at corner `side`, 1 at the next) on a side.
Eigen::Vector2d on_side(int sides, int side, double s);

/// Local coordinates of a corner of the face with its boundary sides moved outwards.
Eigen::Vector2d extended_corner(const Face& face, int corner);

/// Returns whether (u, v) lies on the face with its boundary sides moved outwards.
bool inside(const Face& face, double u, double v);

/// How far beyond a side of the boundary: 0 there, 1 where its extension ends.
FaceFunction share_of_extension(const Face& face, int side, double u, double v);

/// Factor of a contact force on the extensions: falls from 1 at the boundary to 0 where they end, with a
/// continuous slope. Eq. (6.2b).
FaceFunction fade_factor(const Face& face, double u, double v);

/// Outward unit normal at (u, v), Eq. (6.3); zero where the face is degenerate.
Eigen::Vector3d normal(const Face& face, double u, double v);

/// Interior angle at a corner, rad; 0 when a side has no length.
double corner_angle(const Face& face, int corner);

/// xi, eta of Eq. (6.1), which on a triangle has its third and fourth node in one place.
Eigen::Vector2d natural_coordinates(int sides, double u, double v);

}  // namespace elastogear::contact
