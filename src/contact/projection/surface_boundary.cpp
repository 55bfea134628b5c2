#include "contact/projection/surface_boundary.h"

#include <Eigen/LU>

namespace elastogear::contact {
namespace {

using Matrix15 = Eigen::Matrix<double, 15, 15>;

// d(y' C)/dx at constant y of the C = a'B + d'S in D = A^-1 C, with S_alpha = spread(0, N_alpha).
Matrix15 direction_derivative(const ProjectionKinematics& foot, const Eigen::Vector2d& y) {
  const Local3 B = spread(1, -foot.N), S_uv = spread(0, foot.N_uv);
  Matrix15 sum = Matrix15::Zero();
  for (int b = 0; b < foot.n_dir; ++b) {
    sum += y[b] *
           (B.transpose() * tangent_derivative(foot, b) + spread(0, foot.N_a.col(b)).transpose() * foot.d_x +
            S_uv.transpose() * foot.d * foot.D.row(1 - b));
    for (int a = 0; a < foot.n_dir; ++a)
      sum -= y[b] * spread(0, foot.N_a.col(a)).transpose() * foot.a.col(b) * foot.D.row(a);
  }
  return sum;
}

}  // namespace

EndForce end_force(const ProjectionKinematics& foot, const Gap& gap, const NormalForce& whole) {
  if (gap.share.f_a.isZero(0)) return {};
  const LocalRow w_x = gap.share.f_a.transpose() * foot.D;
  const Eigen::Vector2d y = foot.A.inverse() * gap.share.f_a;
  const Eigen::Matrix<double, 2, 15> turn = gap.share.f_ab * foot.D - metric_derivative(foot, y);
  return {-whole.energy * w_x.transpose(),
          -w_x.transpose() * (whole.energy_g * gap.g_x) -
              whole.energy * (foot.D.transpose() * turn + direction_derivative(foot, y))};
}

// W = [B', unit vectors of the master's coordinates]: the first columns are those along which the slave node
// moves, as without ends.
void add_end_force(const EndForce& end, ContactPoint& contact) {
  contact.F.reshaped() += end.F;
  contact.f = contact.F.col(0);
  const auto packed = [&](const Matrix15& K) {
    Matrix15 V = -K.transpose();
    for (int i = 0; i < 4; ++i) V.middleCols<3>(3 + 3 * i) += contact.N[i] * V.leftCols<3>();
    return V;
  };
  const Matrix15 K_x = end.F_x - contact.W * contact.k * contact.V.transpose(),
                 K_v = -contact.W * contact.k * contact.V_dot.transpose();
  contact.V = packed(K_x);
  contact.V_dot = packed(K_v);
  contact.k.setIdentity(15, 15);
  contact.W = Matrix15::Identity();
  contact.W.leftCols<3>() = spread(1, -contact.N).transpose();
}

}  // namespace elastogear::contact
