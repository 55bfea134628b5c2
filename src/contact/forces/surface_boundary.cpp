#include "contact/forces/surface_boundary.h"

#include <Eigen/LU>

namespace elastogear::contact {
namespace {

using Matrix15 = Eigen::Matrix<double, 15, 15>;

// sum += factor [slave I, weight_i I]' rows, which repeats the three rows for each node.
void add_spread(double factor, double slave, const Eigen::Vector4d& weight, const Local3& rows,
                Matrix15& sum) {
  if (slave != 0) sum.topRows<3>() += factor * slave * rows;
  for (int i = 0; i < 4; ++i) sum.middleRows<3>(3 + 3 * i) += factor * weight[i] * rows;
}

// d(y' C)/dx at constant y of the C = a'B + d'S in D = A^-1 C, with S_alpha = spread(0, N_alpha).
Matrix15 direction_derivative(const ProjectionKinematics& kinematics, const Eigen::Vector2d& y) {
  Matrix15 sum = Matrix15::Zero();
  for (int b = 0; b < kinematics.n_dir; ++b) {
    add_spread(y[b], 1, -kinematics.N, tangent_derivative(kinematics, b), sum);
    add_spread(y[b], 0, kinematics.N_a.col(b), kinematics.d_x, sum);
    add_spread(y[b], 0, kinematics.N_uv, kinematics.d * kinematics.D.row(1 - b), sum);
    for (int a = 0; a < kinematics.n_dir; ++a)
      add_spread(-y[b], 0, kinematics.N_a.col(a), kinematics.a.col(b) * kinematics.D.row(a), sum);
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
              e.e * (kinematics.D.transpose().lazyProduct(turn) + direction_derivative(kinematics, y)),
          -w_x.transpose() * e.e_v};
}

// W = [B', unit vectors of the master's coordinates]: the first columns are those along which the slave node
// moves, as without a boundary.
void add_boundary_force(const BoundaryForce& boundary, ContactPoint& contact) {
  contact.F.reshaped() += boundary.F;
  contact.f = contact.F.col(0);
  // -K' of K = K_boundary - W k V', with the slave node's columns added to those of the master's nodes
  const auto packed = [&](const Matrix15& of_boundary, const LocalColumns& of_contact) {
    Matrix15 V = -of_boundary.transpose();
    if (!of_contact.isZero(0)) {
      const LocalColumns W_k = contact.W.lazyProduct(contact.k);
      V.noalias() += of_contact.lazyProduct(W_k.transpose());
    }
    for (int i = 0; i < 4; ++i) V.middleCols<3>(3 + 3 * i) += contact.N[i] * V.leftCols<3>();
    return V;
  };
  const Matrix15 V = packed(boundary.F_x, contact.V), V_dot = packed(boundary.F_v, contact.V_dot);
  contact.V = V;
  contact.V_dot = V_dot;
  contact.k.setIdentity(15, 15);
  contact.W = Matrix15::Identity();
  contact.W.leftCols<3>() = spread(1, -contact.N).transpose();
}

}  // namespace elastogear::contact
