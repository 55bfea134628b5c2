#pragma once
// Surfaces and states for the contact tests.

#include <Eigen/Geometry>
#include <functional>
#include <random>

#include "elastogear/contact/pair.h"

namespace elastogear::contact::test {

constexpr double pi = 3.14159265358979323846;

inline Eigen::Matrix3d rotation(const Eigen::Vector3d& psi) {
  const double angle = psi.norm();
  return angle > 0 ? Eigen::AngleAxisd(angle, psi / angle).toRotationMatrix()
                   : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
}

/// n_u x n_v faces over [0, 1]^2, mapped to space; the normal is x_u x x_v.
inline model::Surface grid(int n_u, int n_v, const std::function<Eigen::Vector3d(double, double)>& map) {
  model::Surface s;
  s.X.resize(3, (n_u + 1) * (n_v + 1));
  s.face.resize(4, n_u * n_v);
  const auto node = [&](int i, int j) { return j * (n_u + 1) + i; };
  for (int j = 0; j <= n_v; ++j)
    for (int i = 0; i <= n_u; ++i) s.X.col(node(i, j)) = map(double(i) / n_u, double(j) / n_v);
  for (int j = 0; j < n_v; ++j)
    for (int i = 0; i < n_u; ++i)
      s.face.col(j * n_u + i) << node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1);
  s.c_f = Eigen::VectorXd::Constant(s.face.cols(), 1e12);
  return s;
}

/// Plane of the given size, normal +z.
inline model::Surface plane(int n_u, int n_v, double l_u = 1, double l_v = 1) {
  return grid(n_u, n_v, [=](double u, double v) { return Eigen::Vector3d(l_u * u, l_v * v, 0); });
}

/// Same faces seen from the other side.
inline model::Surface flipped(model::Surface s) {
  for (auto f : s.face.colwise()) f = f.reverse().eval();
  return s;
}

/// Every quadrilateral cut in two triangles.
inline model::Surface triangulated(const model::Surface& s) {
  model::Surface t = s;
  t.face.resize(4, 2 * s.face.cols());
  for (int f = 0; f < s.face.cols(); ++f) {
    t.face.col(2 * f) << s.face(0, f), s.face(1, f), s.face(2, f), s.face(2, f);
    t.face.col(2 * f + 1) << s.face(0, f), s.face(2, f), s.face(3, f), s.face(3, f);
  }
  t.c_f = Eigen::VectorXd::Constant(t.face.cols(), 1e12);
  return t;
}

/// Closed surface: the cube [-1, 1]^3 with n^2 faces a side, mapped to space; nodes on shared edges are one.
model::Surface cube(int n, const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& map);

inline Eigen::Vector3d same(const Eigen::Vector3d& x) { return x; }
inline Eigen::Vector3d onto_sphere(const Eigen::Vector3d& x) { return x.normalized(); }

inline SurfaceState at(const model::Surface& s, const Eigen::Vector3d& r = Eigen::Vector3d::Zero(),
                       const Eigen::Vector3d& psi = Eigen::Vector3d::Zero()) {
  return {s.X, r, rotation(psi)};
}

struct Random {
  std::mt19937 engine;
  explicit Random(unsigned seed) : engine(seed) {}
  double uniform(double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(engine); }
  int integer(int lo, int hi) { return std::uniform_int_distribution<int>(lo, hi)(engine); }
  Eigen::Vector3d vector(double size) {
    return {uniform(-size, size), uniform(-size, size), uniform(-size, size)};
  }
};

inline Eigen::Vector3d total_force(const std::vector<ContactPoint>& contacts) {
  Eigen::Vector3d f = Eigen::Vector3d::Zero();
  for (const ContactPoint& c : contacts) f += c.f;
  return f;
}

}  // namespace elastogear::contact::test
