#include "elastogear/body/tangent.h"

#include <Eigen/Geometry>

#include "elastogear/base/rotation.h"
#include "elastogear/body/deformed_inertia.h"

namespace elastogear::body {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;

// Motion, inertia and derivatives that all parts of the tangent need. a includes the weight: a - g.
struct State {
  const Equations& eq;
  const Motion& m;
  Shifts shift;
  FrameMotion frame;
  FrameDerivative d;
  Shape shape;
  Vector3d a;
  Matrix3d W;  // skew(w)
};

State evaluate(const Equations& eq, const Motion& m, const Vector3d& g_W, const Shifts& shift) {
  const JointMotion joint{m.s, m.s_dot, m.s_ddot};
  State x{eq,
          m,
          shift,
          frame_motion(eq, m),
          frame_derivative(eq.joint, eq.H, joint, shift),
          shape(eq, m),
          Vector3d::Zero(),
          Matrix3d::Zero()};
  const Vector3d g_B = placement(eq.joint, m.s).R_WB.transpose() * g_W;
  x.a = x.frame.a() - g_B;
  x.d.a -= skew(g_B) * x.d.theta;
  x.W = skew(x.frame.w);
  return x;
}

// Block C of the joint coordinates: docs/theory, Eq. (8.13).
MatrixXd joint_block(const State& x) {
  const Shape& shape = x.shape;
  const Matrix3d S = skew(shape.S);
  const Vector3d w = x.frame.w;
  const Matrix3d dv = -skew(w.cross(shape.S)) - x.W * S - 2 * skew(shape.S_dot);
  const Matrix3d dw = -skew(shape.J * w) + x.W * shape.J + shape.J_dot - skew(shape.spin);
  const MatrixXd F_v = x.eq.body->inertia.m * x.d.a - S * x.d.alpha + dv * x.d.w;
  const MatrixXd F_w = S * x.d.a + shape.J * x.d.alpha + dw * x.d.w;
  return x.eq.H.topRows<3>().transpose() * F_v + x.eq.H.bottomRows<3>().transpose() * F_w;
}

// [C_l, C_r, J_1], n_y x 12 (constant: 6)
MatrixXd first_order_columns(const Equations& eq) {
  MatrixXd U(eq.J_1.rows(), 6 + eq.J_1.cols());
  U << eq.inertia().C_l, eq.inertia().C_r, eq.J_1;
  return U;
}

// Rows rho, the changes of F_v and F_w with C_l'y, C_r'y and J_1'y: docs/theory, Eq. (8.15).
MatrixXd row_coefficients(const State& x) {
  const bool constant = x.eq.level == InertiaLevel::constant;
  const Matrix3d I = Matrix3d::Identity();
  MatrixXd N = MatrixXd::Zero(6, constant ? 6 : 12);
  N.topLeftCorner<3, 3>() = x.shift.a * I;
  N.block<3, 3>(3, 3) = x.shift.a * I;
  if (constant) return N;
  N.topLeftCorner<3, 3>() += skew(x.frame.alpha) + x.W * x.W + 2 * x.shift.v * x.W;
  N.bottomLeftCorner<3, 3>() = -skew(x.a);
  N.block<3, 3>(3, 3) += x.shift.v * x.W;
  N.bottomRightCorner<3, 6>() = factor(x.frame.alpha + x.shift.v * x.frame.w) + x.W * factor(x.frame.w);
  return N;
}

// Columns beta: docs/theory, Eq. (8.14).
MatrixXd column_coefficients(const State& x) {
  const bool constant = x.eq.level == InertiaLevel::constant;
  MatrixXd beta(constant ? 6 : 12, x.eq.n_s());
  beta.topRows<3>() = x.d.a;
  beta.middleRows<3>(3) = x.d.alpha;
  if (!constant) beta.bottomRows<6>() = -factor(x.frame.w).transpose() * x.d.w;
  return beta;
}

// Second-order parts: of F_w with y (3 x n_y), and of the force on y with s (n_y x n_s).
MatrixXd second_order_rows(const State& x) {
  const Vector3d w = x.frame.w;
  const SecondOrder at_y_ddot = second_order(x.eq, to_inertia(x.eq, x.m.q_ddot));
  const Matrix36 Y = factor(w), Y_row = factor(x.frame.alpha + x.shift.v * w) + x.W * Y;
  const Matrix3d by_B = x.shift.a * Matrix3d::Identity() + x.shift.v * x.W;
  return Y_row * x.shape.at_y.D.transpose() + Y * x.shape.at_y_dot.D.transpose() +
         by_B * x.shape.at_y.B.transpose() - at_y_ddot.B.transpose() - x.W * x.shape.at_y_dot.B.transpose();
}

MatrixXd second_order_columns(const State& x) {
  const Matrix36 Y = factor(x.frame.w);
  return x.shape.at_y.B * x.d.alpha + (2 * x.shape.at_y_dot.B - x.shape.at_y.D * Y.transpose()) * x.d.w;
}

void add_second_order(const State& x, Tangent& t) {
  const Vector3d w = x.frame.w;
  const MatrixXd R_y = x.eq.H.bottomRows<3>().transpose() * second_order_rows(x),
                 Q_s = second_order_columns(x);
  t.Gamma = x.W * x.W + skew(x.frame.alpha + 2 * x.shift.v * w);
  if (x.eq.level == InertiaLevel::full) {
    t.R_q = R_y;
    t.Q_s = Q_s;
  } else {
    const MatrixXd U = first_order_columns(x.eq);
    t.rho = U * t.rho + R_y.transpose();
    t.beta = U * t.beta + Q_s;
  }
}

}  // namespace

MatrixXd border(const Equations& eq) {
  if (eq.n_s() == 0) return MatrixXd(eq.n_q(), 0);
  return eq.level == InertiaLevel::affine ? eq.affine.Y : first_order_columns(eq);
}

MatrixXd stiffness_in_border(const Equations& eq, const Matrix3d& Gamma) {
  if (eq.level != InertiaLevel::affine || Gamma.isZero(0)) return {};
  MatrixXd Z = MatrixXd::Zero(12, 12);
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) Z.block<4, 4>(4 * a, 4 * b).diagonal().setConstant(Gamma(a, b));
  return Z;
}

Tangent tangent(const Equations& eq, const Motion& m, const Vector3d& g_W, const Shifts& shift) {
  const State x = evaluate(eq, m, g_W, shift);
  Tangent t;
  t.C = joint_block(x);
  t.Gamma.setZero();
  if (eq.n_s() == 0) {
    t.beta = t.rho = MatrixXd(0, 0);
  } else {
    t.beta = column_coefficients(x);
    t.rho = row_coefficients(x).transpose() * eq.H;
  }
  if (eq.second_order() && eq.n_s() > 0) add_second_order(x, t);
  return t;
}

}  // namespace elastogear::body
