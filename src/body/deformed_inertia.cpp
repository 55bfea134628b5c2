#include "elastogear/body/deformed_inertia.h"

namespace elastogear::body {
namespace {

using Eigen::VectorXd;

// S^ab x, with Inertia::S_2 in the order 11 22 33 12 23 13 and S^ba = (S^ab)'.
VectorXd moment(const model::Inertia& inertia, int a, int b, const VectorXd& x) {
  constexpr int kPlace[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
  const model::BasisRows& S = inertia.S_2[kPlace[a][b]];
  return a <= b ? model::multiply(S, x) : model::multiply_transposed(S, x);
}

SecondOrder full_second_order(const model::Inertia& inertia, const VectorXd& x) {
  VectorXd S[3][3];
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) S[a][b] = moment(inertia, a, b, x);
  SecondOrder order;
  order.B.resize(x.size(), 3);
  order.D.resize(x.size(), 6);
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    order.B.col(a) = S[c][b] - S[b][c];
    order.D.col(a) = 2 * (S[b][b] + S[c][c]);
  }
  order.D.col(3) = -S[0][1] - S[1][0];
  order.D.col(4) = -S[1][2] - S[2][1];
  order.D.col(5) = -S[0][2] - S[2][0];
  return order;
}

// Second-order parts at level affine, where S^ab x = [x_b in place of x_a] for the three parts of x.
SecondOrder affine_second_order(const VectorXd& x) {
  constexpr int kMixed[3][2] = {{0, 1}, {1, 2}, {0, 2}};
  const auto part = [&](int a) { return x.segment<4>(4 * a); };
  SecondOrder order;
  order.B.setZero(12, 3);
  order.D.setZero(12, 6);
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    order.B.col(a).segment<4>(4 * c) = part(b);
    order.B.col(a).segment<4>(4 * b) = -part(c);
    order.D.col(a).segment<4>(4 * b) = 2 * part(b);
    order.D.col(a).segment<4>(4 * c) = 2 * part(c);
    const auto [d, e] = kMixed[a];
    order.D.col(3 + a).segment<4>(4 * d) = -part(e);
    order.D.col(3 + a).segment<4>(4 * e) = -part(d);
  }
  return order;
}

}  // namespace

Matrix36 factor(const Eigen::Vector3d& y) {
  Matrix36 Y;
  Y << y[0], 0, 0, y[1], 0, y[2], 0, y[1], 0, y[0], y[2], 0, 0, 0, y[2], 0, y[1], y[0];
  return Y;
}

SecondOrder second_order(const Equations& eq, const VectorXd& x) {
  return eq.level == InertiaLevel::affine ? affine_second_order(x) : full_second_order(eq.body->inertia, x);
}

VectorXd contract(const model::Inertia& inertia, const Eigen::Matrix3d& Gamma, const VectorXd& x) {
  VectorXd sum = VectorXd::Zero(x.size());
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) sum += Gamma(a, b) * moment(inertia, a, b, x);
  return sum;
}

VectorXd to_inertia(const Equations& eq, const VectorXd& q) {
  return eq.level == InertiaLevel::affine ? VectorXd(eq.affine.Y.transpose() * q) : q;
}

VectorXd from_inertia(const Equations& eq, const VectorXd& h_y) {
  return eq.level == InertiaLevel::affine ? VectorXd(eq.affine.Y * h_y) : h_y;
}

Eigen::Vector3d first_moment(const Equations& eq, const VectorXd& y) {
  const model::Inertia& inertia = eq.inertia();
  if (eq.level == InertiaLevel::constant) return inertia.m * inertia.c;
  return inertia.m * inertia.c + inertia.C_l.transpose() * y;
}

Shape shape(const Equations& eq, const Motion& m) {
  const model::Inertia& inertia = eq.inertia();
  const VectorXd y = to_inertia(eq, m.q);
  Shape shape{to_inertia(eq, m.q_dot),
              first_moment(eq, y),
              Eigen::Vector3d::Zero(),
              inertia.J,
              Eigen::Matrix3d::Zero(),
              Eigen::Vector3d::Zero(),
              {},
              {}};
  if (eq.level == InertiaLevel::constant) return shape;
  const VectorXd& y_dot = shape.y_dot;
  shape.S_dot = inertia.C_l.transpose() * y_dot;
  shape.J += symmetric(eq.J_1.transpose() * y);
  shape.J_dot = symmetric(eq.J_1.transpose() * y_dot);
  if (eq.second_order()) {
    shape.at_y = second_order(eq, y);
    shape.at_y_dot = second_order(eq, y_dot);
    shape.J += 0.5 * symmetric(shape.at_y.D.transpose() * y);
    shape.J_dot += symmetric(shape.at_y.D.transpose() * y_dot);
  }
  shape.spin = project_C_r(eq, shape, y_dot);
  return shape;
}

Eigen::Vector3d project_C_r(const Equations& eq, const Shape& shape, const VectorXd& x) {
  Eigen::Vector3d projected = eq.inertia().C_r.transpose() * x;
  if (eq.second_order()) projected += shape.at_y.B.transpose() * x;
  return projected;
}

}  // namespace elastogear::body
