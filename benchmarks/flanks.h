#pragma once
// Two flank-like surfaces of 10,100 and 11,800 quadrilaterals, 32 x 80 mm, tilted by 0.7 rad against the
// k-DOP axes. `contact` 0: localised, 1: medium, 2: conforming over the full width.

#include <Eigen/Geometry>

#include "elastogear/contact/pair.h"

namespace elastogear::contact {

inline model::Surface flank(int n_u, int n_v, double curvature_u, double curvature_v, bool up) {
  model::Surface s;
  s.X.resize(3, (n_u + 1) * (n_v + 1));
  s.face.resize(4, n_u * n_v);
  const auto node = [&](int i, int j) { return j * (n_u + 1) + i; };
  for (int j = 0; j <= n_v; ++j)
    for (int i = 0; i <= n_u; ++i) {
      const double x = 0.032 * (static_cast<double>(i) / n_u - 0.5),
                   y = 0.08 * (static_cast<double>(j) / n_v - 0.5);
      s.X.col(node(i, j)) << x, y, 0.5 * (curvature_u * x * x + curvature_v * y * y);
    }
  for (int j = 0; j < n_v; ++j)
    for (int i = 0; i < n_u; ++i) {
      auto f = s.face.col(j * n_u + i);
      f << node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1);
      if (!up) f.reverseInPlace();
    }
  s.c_f = Eigen::VectorXd::Constant(s.face.cols(), 1e14);
  return s;
}

struct Flanks {
  model::Surface a, b;
  SurfaceState state_a, state_b;
};

inline Flanks flanks(int contact) {
  const double curvature[3][2] = {{25, 130}, {5, 60}, {0, 5}};  // 1/m, relative
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const double depth = 10e-6;
  Flanks f{flank(101, 100, curvature[contact][0], curvature[contact][1], false),
           flank(100, 118, 0, 0, true),
           {},
           {}};
  f.state_a = {f.a.X, R * Eigen::Vector3d(1e-4, 2e-4, -depth), R};
  f.state_b = {f.b.X, Eigen::Vector3d::Zero(), R};
  return f;
}

/// Both surfaces in the world frame.
struct PlacedFlanks {
  Flanks f;
  Eigen::Matrix3Xd x_a, x_b;
};

inline PlacedFlanks placed_flanks(int contact) {
  PlacedFlanks p{flanks(contact), {}, {}};
  p.x_a = (p.f.state_a.R_WB * p.f.a.X).colwise() + p.f.state_a.r_WB;
  p.x_b = p.f.state_b.R_WB * p.f.b.X;
  return p;
}

}  // namespace elastogear::contact
