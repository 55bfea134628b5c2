#include "contact/projection/surface_boundary.h"

#include <Eigen/LU>

namespace elastogear::contact {
namespace {

using Matrix15 = Eigen::Matrix<double, 15, 15>;

// d(y' C)/dx at constant y of the C = a'B + d'S in D = A^-1 C, with S_alpha = spread(0, N_alpha).
Matrix15 direction_derivative(const ProjectionKinematics& kinematics, const Eigen::Vector2d& y) {
  const Local3 B = spread(1, -kinematics.N), S_uv = spread(0, kinematics.N_uv);
  Matrix15 sum = Matrix15::Zero();
  for (int b = 0; b < kinematics.n_dir; ++b) {
    sum += y[b] * (B.transpose() * tangent_derivative(kinematics, b) +
                   spread(0, kinematics.N_a.col(b)).transpose() * kinematics.d_x +
                   S_uv.transpose() * kinematics.d * kinematics.D.row(1 - b));
    for (int a = 0; a < kinematics.n_dir; ++a)
      sum -= y[b] * spread(0, kinematics.N_a.col(a)).transpose() * kinematics.a.col(b) * kinematics.D.row(a);
  }
  return sum;
}

}  // namespace

BoundaryForce boundary_force(const ProjectionKinematics& kinematics, const Gap& gap, const FadingEnergy& e) {
  if (gap.fade.f_a.isZero(0)) return {};
  const LocalRow w_x = gap.fade.f_a.transpose() * kinematics.D;
  const Eigen::Vector2d y = kinematics.A.inverse() * gap.fade.f_a;
  const Eigen::Matrix<double, 2, 15> turn = gap.fade.f_ab * kinematics.D - metric_derivative(kinematics, y);
  return {-e.e * w_x.transpose(),
          -w_x.transpose() * e.e_x -
              e.e * (kinematics.D.transpose() * turn + direction_derivative(kinematics, y)),
          -w_x.transpose() * e.e_v};
}

// W = [B', unit vectors of the master's coordinates]: the first columns are those along which the slave node
// moves, as without a boundary.
void add_boundary_force(const BoundaryForce& boundary, ContactPoint& contact) {
  contact.F.reshaped() += boundary.F;
  contact.f = contact.F.col(0);
  const auto packed = [&](const Matrix15& K) {
    Matrix15 V = -K.transpose();
    for (int i = 0; i < 4; ++i) V.middleCols<3>(3 + 3 * i) += contact.N[i] * V.leftCols<3>();
    return V;
  };
  const Matrix15 K_x = boundary.F_x - contact.W * contact.k * contact.V.transpose(),
                 K_v = boundary.F_v - contact.W * contact.k * contact.V_dot.transpose();
  contact.V = packed(K_x);
  contact.V_dot = packed(K_v);
  contact.k.setIdentity(15, 15);
  contact.W = Matrix15::Identity();
  contact.W.leftCols<3>() = spread(1, -contact.N).transpose();
}

}  // namespace elastogear::contact
