// Directions of forces that turn, and points that move, while gaps close, found in one linear solution
// (docs/theory.md, Eq. (6.25a)).

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <optional>

#include "dynamics/contact/unilateral_forces.h"

namespace elastogear::dynamics {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// W k V' takes p and t for those of a penalty 1 / c, K. What they make up for, A y_x' with A by gap and u, is
// taken out of V: dF = -W k V_turn' dx at unchanged p and t, with W k (V - V_turn)' = F_z A y_x'.
void UnilateralForces::let_turn(Contact& contact) {
  const contact::ContactPoint& point = *contact.point;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, Eigen::Dynamic, 3> F_z(point.W.rows(), contact.n),
      y_x(point.W.rows(), contact.n);
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3> A(contact.n, contact.n);
  A.setZero();
  A(0, 0) = 1 / point.c;
  F_z.col(0) = point.F_p.reshaped();
  y_x.col(0) = point.g_x.reshaped();
  if (point.tangential) {
    const contact::TangentialForce& f = *point.tangential;
    A.bottomRightCorner<2, 2>() = f.K;
    if (f.slides) A.bottomLeftCorner<2, 1>() = f.t / (point.p * point.c);
    F_z.rightCols<2>() = f.F_t;
    y_x.rightCols<2>() = f.u_x;
  }
  contact.W_k = point.W * point.k;
  const MatrixXd b = MatrixXd(contact.W_k).colPivHouseholderQr().solve(F_z * A);
  contact.V_turn = point.V - y_x * b.transpose();
  contact.n_turns = point.k.rows();
}

// The displacements u of the contacts that turn, and the forces z, are linear in each other: u = a + B z +
// M u, y = q + C z + D u: docs/theory.md, Eq. (6.25a).
std::optional<UnilateralForces::Turning> UnilateralForces::turning() const {
  Index n = 0;
  for (const Contact& contact : contacts_) n += contact.n_turns;
  Turning t{C_, MatrixXd::Zero(n, z_.size()), q_, VectorXd::Zero(n)};
  if (n == 0) return t;
  MatrixXd I_M = MatrixXd::Identity(n, n), D = MatrixXd::Zero(z_.size(), n);
  for (const Body& body : bodies_) {
    MatrixXd R_T = MatrixXd::Zero(body.R->rows(), n);
    for (const Touch& touch : body.touches)
      if (const Contact& c = contacts_[touch.contact]; c.n_turns > 0)
        R_T.middleCols(c.turn, c.n_turns) -=
            body.R->middleCols<3>(touch.row).lazyProduct(body.R_BW * c.W_k.middleRows<3>(3 * touch.local));
    for (const Touch& touch : body.touches) {
      const Contact& c = contacts_[touch.contact];
      D.middleRows(c.first, c.n) += touch.y_x.transpose().lazyProduct(R_T.middleRows<3>(touch.row));
      if (c.n_turns == 0) continue;
      const Rows V = body.R_BW * c.V_turn.middleRows<3>(3 * touch.local);
      I_M.middleRows(c.turn, c.n_turns) -= V.transpose().lazyProduct(R_T.middleRows<3>(touch.row));
      t.B.middleRows(c.turn, c.n_turns) += V.transpose().lazyProduct(body.response.middleRows<3>(touch.row));
      t.a.segment(c.turn, c.n_turns) += V.transpose() * body.missing.segment<3>(touch.row);
    }
  }
  const Eigen::PartialPivLU<MatrixXd> lu(I_M);
  t.B = lu.solve(t.B).eval();
  t.a = lu.solve(t.a).eval();
  if (!t.B.allFinite() || !t.a.allFinite()) return {};
  t.a -= t.B * z_found_;
  t.C += D * t.B;
  t.q += D * t.a;
  return t;
}

// Leaves the directions as they are of forces that end, and where they would change far beyond their size, as
// at edges, to which they may point from anywhere. Returns whether there are any.
bool UnilateralForces::leave_out(const VectorXd& z, const VectorXd& u) {
  constexpr double kFar = 2;  // of the force
  bool any = false;
  for (Contact& c : contacts_) {
    if (c.n_turns == 0) continue;
    const double turned = (c.W_k * u.segment(c.turn, c.n_turns)).norm();
    if (z[c.first] > 0 && turned <= kFar * std::max(z[c.first], c.point->p)) continue;
    c.n_turns = 0;
    any = true;
  }
  return any;
}

// Finds forces and the displacements by which they turn in one linear solution. Points may move so far on
// flat gaps that substitution of one in the other does not come to rest.
bool UnilateralForces::turn_at_once() {
  constexpr int kMostRounds = 5;
  for (Contact& contact : contacts_)
    if (contact.point->p > 0) let_turn(contact);
  for (int round = 0; round < kMostRounds; ++round) {
    Index n = 0;
    for (Contact& contact : contacts_) {
      contact.turn = n;
      n += contact.n_turns;
    }
    const std::optional<Turning> turning = this->turning();
    const std::optional<VectorXd> z = turning ? forces(turning->C, turning->q) : std::nullopt;
    if (!z) return false;
    const VectorXd u = turning->a + turning->B * *z;
    if (leave_out(*z, u)) continue;
    z_ = *z;
    for (Body& body : bodies_) {
      body.turned.setZero();
      for (const Touch& t : body.touches)
        if (const Contact& c = contacts_[t.contact]; c.n_turns > 0)
          body.turned.segment<3>(t.row) -=
              body.R_BW * (c.W_k.middleRows<3>(3 * t.local) * u.segment(c.turn, c.n_turns));
    }
    return true;
  }
  return false;
}

}  // namespace elastogear::dynamics
