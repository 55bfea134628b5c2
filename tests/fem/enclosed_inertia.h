#pragma once
// Mass, centre and inertia of the volume that a mesh's outer faces enclose: the cells are not looked at.

#include <cmath>

#include "elastogear/mesh/mesh.h"
#include "elastogear/model/elastic_body.h"

namespace elastogear::test {

// integral of x^i y^j z^k over the mesh by the divergence theorem on its outer faces, 4x4 Gauss points each.
inline double surface_moment(const mesh::Mesh& mesh, const Eigen::Vector3i& power) {
  const double a = std::sqrt(3. / 7 - 2. / 7 * std::sqrt(1.2)),
               b = std::sqrt(3. / 7 + 2. / 7 * std::sqrt(1.2));
  const double wa = (18 + std::sqrt(30.)) / 36, wb = (18 - std::sqrt(30.)) / 36;
  const double xi[4] = {-b, -a, a, b}, w[4] = {wb, wa, wa, wb};
  double sum = 0;
  for (const mesh::Face& f : mesh::boundary_faces(mesh))
    for (int p = 0; p < 16; ++p) {
      const double r = xi[p % 4], s = xi[p / 4];
      const Eigen::Vector4d N =
          Eigen::Vector4d((1 - r) * (1 - s), (1 + r) * (1 - s), (1 + r) * (1 + s), (1 - r) * (1 + s)) / 4;
      const Eigen::Vector4d N_r = Eigen::Vector4d(-(1 - s), 1 - s, 1 + s, -(1 + s)) / 4;
      const Eigen::Vector4d N_s = Eigen::Vector4d(-(1 - r), -(1 + r), 1 + r, 1 - r) / 4;
      const Eigen::Matrix<double, 3, 4> X = mesh.X(Eigen::all, f);
      const Eigen::Vector3d x = X * N, t = X * N_r, u = X * N_s;
      const double n_x = t.y() * u.z() - t.z() * u.y();
      sum += w[p % 4] * w[p / 4] * n_x * std::pow(x.x(), power.x() + 1) / (power.x() + 1) *
             std::pow(x.y(), power.y()) * std::pow(x.z(), power.z());
    }
  return sum;
}

/// Of a body of uniform density rho (kg/m^3); m, c, J about the origin.
inline model::Inertia enclosed_inertia(const mesh::Mesh& mesh, double rho) {
  const auto moment = [&](int i, int j, int k) { return rho * surface_moment(mesh, {i, j, k}); };
  model::Inertia inertia;
  inertia.m = moment(0, 0, 0);
  inertia.c = Eigen::Vector3d(moment(1, 0, 0), moment(0, 1, 0), moment(0, 0, 1)) / inertia.m;
  Eigen::Matrix3d P;
  P << moment(2, 0, 0), moment(1, 1, 0), moment(1, 0, 1), moment(1, 1, 0), moment(0, 2, 0), moment(0, 1, 1),
      moment(1, 0, 1), moment(0, 1, 1), moment(0, 0, 2);
  inertia.J = P.trace() * Eigen::Matrix3d::Identity() - P;
  return inertia;
}

}  // namespace elastogear::test
