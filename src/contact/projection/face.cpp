#include "elastogear/contact/face.h"

#include <Eigen/Geometry>
#include <cmath>

namespace elastogear::contact {
namespace {

constexpr std::array<double, 4> kCornerXi{-1, 1, 1, -1}, kCornerEta{-1, -1, 1, 1};

Eigen::Vector2d corner_coordinates(int sides, int corner) {
  if (sides == 4) return {kCornerXi[corner], kCornerEta[corner]};
  return {corner == 1 ? 1.0 : 0.0, corner == 2 ? 1.0 : 0.0};
}

// How far beyond a side, in shares of the face's length: offset + slope . (u, v).
struct Beyond {
  double offset;
  Eigen::Vector2d slope;
};

Beyond beyond(int sides, int side) {
  if (sides == 3) {
    constexpr std::array<std::array<double, 2>, 3> kOutwards{{{0, -1}, {1, 1}, {-1, 0}}};
    return {side == 1 ? -1.0 : 0.0, {kOutwards[side][0], kOutwards[side][1]}};
  }
  constexpr std::array<std::array<double, 2>, 4> kOutwards{{{0, -1}, {1, 0}, {0, 1}, {-1, 0}}};
  return {-0.5, 0.5 * Eigen::Vector2d(kOutwards[side][0], kOutwards[side][1])};
}

// From 1 at t = 0 to 0 at t = 1, of a linear t.
FaceFunction fall(const FaceFunction& linear) {
  const double t = linear.f;
  if (t <= 0) return {1};
  if (t >= 1) return {};
  return {(1 - t) * (1 - t) * (1 + 2 * t), -6 * t * (1 - t) * linear.f_a,
          (12 * t - 6) * (linear.f_a * linear.f_a.transpose())};
}

FaceFunction product(const FaceFunction& a, const FaceFunction& b) {
  const Eigen::Matrix2d mixed = a.f_a * b.f_a.transpose();
  return {a.f * b.f, a.f * b.f_a + b.f * a.f_a, a.f * b.f_ab + b.f * a.f_ab + mixed + mixed.transpose()};
}

}  // namespace

Shape shape(int sides, double u, double v) {
  if (sides == 3) return {{1 - u - v, u, v, 0}, {-1, 1, 0, 0}, {-1, 0, 1, 0}, {0, 0, 0, 0}};
  return {0.25 * Eigen::Vector4d((1 - u) * (1 - v), (1 + u) * (1 - v), (1 + u) * (1 + v), (1 - u) * (1 + v)),
          0.25 * Eigen::Vector4d(-(1 - v), 1 - v, 1 + v, -(1 + v)),
          0.25 * Eigen::Vector4d(-(1 - u), -(1 + u), 1 + u, 1 - u), 0.25 * Eigen::Vector4d(1, -1, 1, -1)};
}

Eigen::Vector3d combine(const Face& face, const Eigen::Vector4d& weight) {
  Eigen::Vector3d sum = weight[0] * face.x[0];
  for (int i = 1; i < face.sides; ++i) sum += weight[i] * face.x[i];
  return sum;
}

Eigen::Vector2d on_side(int sides, int side, double s) {
  return (1 - s) * corner_coordinates(sides, side) + s * corner_coordinates(sides, (side + 1) % sides);
}

Eigen::Vector2d extended_corner(const Face& face, int corner) {
  const int after = corner, before = (corner + face.sides - 1) % face.sides;
  const double e_after = face.extension[after], e_before = face.extension[before];
  if (face.sides == 4) {  // even sides lie at eta = -+1, odd ones at xi = +-1
    const double along_xi = corner % 2 == 0 ? e_before : e_after;
    const double along_eta = corner % 2 == 0 ? e_after : e_before;
    return {kCornerXi[corner] * (1 + 2 * along_xi), kCornerEta[corner] * (1 + 2 * along_eta)};
  }
  std::array<double, 3> weight;  // a side moved by e leaves its far corner the weight -e
  weight[corner] = 1 + e_after + e_before;
  weight[(corner + 1) % 3] = -e_before;
  weight[(corner + 2) % 3] = -e_after;
  return {weight[1], weight[2]};
}

bool inside(const Face& face, double u, double v) {
  const auto& e = face.extension;
  if (face.sides == 3) return v >= -e[0] && 1 - u - v >= -e[1] && u >= -e[2];
  return u >= -1 - 2 * e[3] && u <= 1 + 2 * e[1] && v >= -1 - 2 * e[0] && v <= 1 + 2 * e[2];
}

FaceFunction share_of_extension(const Face& face, int side, double u, double v) {
  const Beyond way = beyond(face.sides, side);
  const Eigen::Vector2d slope = way.slope / face.extension[side];
  return {way.offset / face.extension[side] + slope.dot(Eigen::Vector2d(u, v)), slope};
}

FaceFunction fade_factor(const Face& face, double u, double v) {
  FaceFunction fade{1};
  for (int side = 0; side < face.sides; ++side)
    if (face.extension[side] > 0) fade = product(fade, fall(share_of_extension(face, side, u, v)));
  return fade;
}

Eigen::Vector3d normal(const Face& face, double u, double v) {
  const Shape s = shape(face.sides, u, v);
  const Eigen::Vector3d a_u = combine(face, s.N_u), a_v = combine(face, s.N_v), n = a_u.cross(a_v);
  const double size = n.norm(), roundoff = 1e-14;
  return size > roundoff * (a_u.squaredNorm() + a_v.squaredNorm()) ? Eigen::Vector3d(n / size)
                                                                   : Eigen::Vector3d::Zero();
}

double corner_angle(const Face& face, int corner) {
  const Eigen::Vector3d a = face.x[(corner + 1) % face.sides] - face.x[corner];
  const Eigen::Vector3d b = face.x[(corner + face.sides - 1) % face.sides] - face.x[corner];
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

Eigen::Vector2d natural_coordinates(int sides, double u, double v) {
  if (sides == 4) return {u, v};
  const double rest = 1 - v;  // weight of the first two corners
  return {rest == 0 ? 0 : (2 * u - rest) / rest, 2 * v - 1};
}

}  // namespace elastogear::contact
