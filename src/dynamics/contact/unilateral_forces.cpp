#include "dynamics/contact/unilateral_forces.h"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <limits>
#include <utility>

#include "dynamics/contact/complementarity.h"
#include "dynamics/contact/extrapolation.h"

namespace elastogear::dynamics {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

UnilateralForces::UnilateralForces(const std::vector<PairContacts>& pairs) {
  Index n = 0;
  for (const PairContacts& pair : pairs)
    for (const contact::ContactPoint& point : pair.points) {
      if (!(point.c > 0)) continue;
      contacts_.push_back({&point, &pair, n, point.tangential ? 3 : 1});
      laws_.push_back({n, point.tangential.has_value(), 0});
      any_sticks_ |= point.tangential.has_value();
      n += contacts_.back().n;
    }
  C_.setZero(n, n);
  q_.resize(n);
  z_found_.resize(n);
  for (const Contact& contact : contacts_) {
    const contact::ContactPoint& point = *contact.point;
    const Index i = contact.first;
    q_[i] = point.g_n;
    z_found_[i] = point.p;
    C_(i, i) = point.c;
    if (!point.tangential) continue;
    q_.segment<2>(i + 1) = point.tangential->u;
    z_found_.segment<2>(i + 1) = point.tangential->t;
    C_.diagonal().segment<2>(i + 1).setConstant(point.tangential->c);
  }
  z_ = z_found_;
  moved_.resize(contacts_.size());
}

void UnilateralForces::add(const ResponseNewton::Compliant& compliant, const VectorXd& missing) {
  const MatrixXd& R = compliant.R;
  const Eigen::Matrix3d R_BW = compliant.R_WB.transpose();
  Body body{{},
            &R,
            R_BW,
            missing,
            MatrixXd::Zero(R.rows(), C_.cols()),
            VectorXd::Zero(R.rows()),
            VectorXd::Zero(R.rows())};
  body.touches.reserve(4 * contacts_.size());
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const contact::ContactPoint& point = *contacts_[c].point;
    for (int i = 0; i < point.n_local(); ++i) {
      const LocalNode local = local_node(point, i);
      if (contacts_[c].pair->body[local.side] != static_cast<int>(compliant.body)) continue;
      const auto at = std::lower_bound(compliant.node.begin(), compliant.node.end(), local.node);
      Touch touch{c,
                  3 * (at - compliant.node.begin()),
                  R_BW * point.F_p.col(i),
                  R_BW * point.g_x.col(i),
                  R_BW * point.W.middleRows<3>(3 * i),
                  R_BW * point.displacement_columns().middleRows<3>(3 * i),
                  i};
      if (point.tangential) {
        touch.F_z.conservativeResize(3, 3);
        touch.y_x.conservativeResize(3, 3);
        touch.F_z.rightCols<2>() = R_BW * point.tangential->F_t.middleRows<3>(3 * i);
        touch.y_x.rightCols<2>() = R_BW * point.tangential->u_x.middleRows<3>(3 * i);
      }
      body.touches.push_back(std::move(touch));
    }
  }
  for (const Touch& t : body.touches)  // a few columns at a time, which need no blocks
    body.response.middleCols(contacts_[t.contact].first, t.F_z.cols()) +=
        R.middleCols<3>(t.row).lazyProduct(t.F_z);
  const VectorXd left = missing - body.response * z_found_;
  for (const Touch& t : body.touches) {
    const Contact& contact = contacts_[t.contact];
    C_.middleRows(contact.first, contact.n) +=
        t.y_x.transpose().lazyProduct(body.response.middleRows<3>(t.row));
    q_.segment(contact.first, contact.n) += t.y_x.transpose() * left.segment<3>(t.row);
  }
  bodies_.push_back(std::move(body));
}

// The gaps, and displacements along the master, that are left without forces.
VectorXd UnilateralForces::gaps() const {
  VectorXd q = q_;
  for (const Body& body : bodies_) {
    if (body.turned.isZero(0)) continue;
    const VectorXd w = *body.R * body.turned;
    for (const Touch& t : body.touches)
      q.segment(contacts_[t.contact].first, t.y_x.cols()) += t.y_x.transpose() * w.segment<3>(t.row);
  }
  return q;
}

// Contacts that carry a force are likely to stay closed; before the first solution those that have been
// entered are, too.
std::vector<bool> UnilateralForces::likely() const {
  const bool first = z_ == z_found_;
  std::vector<bool> closed;
  for (const Contact& contact : contacts_)
    closed.push_back(z_[contact.first] > 0 || (first && contact.point->g_n < 0));
  return closed;
}

// The forces that close the present gaps. A node that comes to slide has the coefficient of that, and may
// make others slide. Friction that follows p makes C unsymmetric, so that pivoting may come to no end.
std::optional<VectorXd> UnilateralForces::forces(const MatrixXd& C, const VectorXd& q) {
  if (!any_sticks_) {
    std::optional<VectorXd> p = solve_complementarity(C, q, likely());
    return p ? p : solve_coulomb(C, q, laws_, z_);
  }
  for (std::size_t c = 0; c < laws_.size(); ++c)
    if (laws_[c].sticks) laws_[c].mu = contacts_[c].point->tangential->mu_static;
  std::optional<VectorXd> z = z_;
  for (bool changed = true; changed && z;) {
    z = solve_coulomb(C, q, laws_, *z);
    changed = false;
    for (std::size_t c = 0; z && c < laws_.size(); ++c) {
      if (!slides(laws_[c], *z)) continue;
      const double mu = contacts_[c].point->tangential->mu;
      changed |= laws_[c].mu != mu;
      laws_[c].mu = mu;
    }
  }
  return z;
}

void UnilateralForces::set_changes() {
  const VectorXd dz = z_ - z_found_;
  for (Body& body : bodies_) {
    body.change = body.turned;
    for (const Touch& t : body.touches)
      body.change.segment<3>(t.row) += t.F_z.lazyProduct(forces_of(contacts_[t.contact], dz));
  }
}

// The present displacements of the contacts, of all bodies; bearing: of those alone that were found with a
// force, which is what turns.
void UnilateralForces::set_moved(bool bearing) {
  for (std::size_t c = 0; c < contacts_.size(); ++c) moved_[c] = {Along::Zero(contacts_[c].point->k.rows())};
  for (const Body& body : bodies_) {
    const VectorXd dx = body.missing + *body.R * body.change;
    for (const Touch& t : body.touches) {
      if (bearing && contacts_[t.contact].point->p == 0) continue;
      Displacement& moved = moved_[t.contact];
      moved.k_V += t.V.transpose().lazyProduct(dx.segment<3>(t.row));
      moved.way.head(t.y_x.cols()) += t.y_x.transpose().lazyProduct(dx.segment<3>(t.row));
    }
  }
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const contact::ContactPoint& point = *contacts_[c].point;
    if (bearing && point.p == 0) continue;
    Displacement& moved = moved_[c];
    moved.k_V = (point.k * moved.k_V).eval();
    moved.answered[0] = moved.way[0] / point.c;
    if (!point.tangential) continue;
    const contact::TangentialForce& f = *point.tangential;
    moved.answered.tail<2>() = f.K * moved.way.tail<2>();
    if (f.slides) moved.answered.tail<2>() += f.t / point.p * moved.answered[0];
  }
}

// The change of the forces at unchanged p and t by the present displacements; of all bodies, one after the
// other. W k V' takes p and t for those of a penalty 1 / c, K, which is added again:
// dF = -(W k V' - F_z [1 / c; K] [g_x; u_x]') dx.
VectorXd UnilateralForces::turned_forces() {
  set_moved(true);
  VectorXd all = VectorXd::Zero(all_turned().size());
  Index first = 0;
  for (const Body& body : bodies_) {
    for (const Touch& t : body.touches) {
      if (contacts_[t.contact].point->p == 0) continue;
      const Displacement& moved = moved_[t.contact];
      all.segment<3>(first + t.row) +=
          t.F_z.lazyProduct(moved.answered.head(t.F_z.cols())) - t.W.lazyProduct(moved.k_V);
    }
    first += body.turned.size();
  }
  return all;
}

VectorXd UnilateralForces::all_turned() const {
  Index size = 0;
  for (const Body& body : bodies_) size += body.turned.size();
  VectorXd all(size);
  for (Index first = 0; const Body& body : bodies_) {
    all.segment(first, body.turned.size()) = body.turned;
    first += body.turned.size();
  }
  return all;
}

void UnilateralForces::turn(const VectorXd& all) {
  for (Index first = 0; Body & body : bodies_) {
    body.turned = all.segment(first, body.turned.size());
    first += body.turned.size();
  }
}

void UnilateralForces::freeze_directions() {
  for (Body& body : bodies_) body.turned.setZero();
  for (std::size_t c = 0; c < contacts_.size(); ++c) moved_[c] = {Along::Zero(contacts_[c].point->k.rows())};
}

// Forces turn, and points move, while gaps close: both are brought together by turns, with the extrapolation
// of D. G. Anderson (J. ACM 12, 1965, 547-560). Returns whether they come to rest.
bool UnilateralForces::turn_step_by_step(double tolerance) {
  constexpr int kMostRounds = 24;
  Extrapolation extrapolation;
  for (int round = 0; round < kMostRounds; ++round) {
    const std::optional<VectorXd> z = forces(C_, gaps());
    if (!z) return false;
    z_ = *z;
    set_changes();
    if (z_.size() == 0 || bodies_.empty()) return true;
    const VectorXd before = all_turned(), turned = turned_forces();
    turn(turned);
    if ((turned - before).cwiseAbs().maxCoeff() <= tolerance * z_.cwiseAbs().maxCoeff()) {
      set_moved();
      return true;
    }
    turn(extrapolation.next(before, turned));
  }
  return false;
}

// W k V' takes p and t for those of a penalty 1 / c, K. What they make up for, A y_x' with A by gap and u, is
// taken out of V: dF = -W k V_turn' dx at unchanged p and t, with W k (V - V_turn)' = F_z A y_x'.
void UnilateralForces::couple_direction(Contact& contact) {
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
  contact.V_turn = point.displacement_columns() - y_x * b.transpose();
  contact.n_turns = point.k.rows();
}

// The displacements u of the contacts that turn, and the forces z, are linear in each other: u = a + B z +
// M u, y = q + C z + D u: docs/theory, Eq. (6.25a).
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
  constexpr double kLargestChange = 2;  // of the force
  bool any = false;
  for (Contact& c : contacts_) {
    if (c.n_turns == 0) continue;
    const double turned = (c.W_k * u.segment(c.turn, c.n_turns)).norm();
    if (z[c.first] > 0 && turned <= kLargestChange * std::max(z[c.first], c.point->p)) continue;
    c.n_turns = 0;
    any = true;
  }
  return any;
}

// Finds forces and the displacements by which they turn in one linear solution. Points may move so far on
// flat gaps that substitution of one in the other does not come to rest.
bool UnilateralForces::couple_directions() {
  constexpr int kMostRounds = 5;
  for (Contact& contact : contacts_)
    if (contact.point->p > 0) couple_direction(contact);
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

// Forces turn as gaps close. Where that is not found, by substitution or in one solution, their directions
// stay those that the contacts were detected with.
bool UnilateralForces::solve(double tolerance) {
  freeze_directions();
  turns_ = turn_step_by_step(tolerance);
  if (turns_) return true;
  if (couple_directions()) {
    turns_ = std::all_of(contacts_.begin(), contacts_.end(),
                         [](const Contact& c) { return c.point->p == 0 || c.n_turns > 0; });
    set_changes();
    set_moved();
    return true;
  }
  freeze_directions();
  const std::optional<VectorXd> z = forces(C_, q_);
  if (!z) return false;
  z_ = *z;
  set_changes();
  return true;
}

bool UnilateralForces::slides_anew() const {
  for (std::size_t c = 0; c < contacts_.size(); ++c)
    if (const auto& f = contacts_[c].point->tangential; f && f->slides != slides(laws_[c], z_)) return true;
  return false;
}

namespace {

// Friction, and what the node remembers, at new forces, after the contact has moved by `way` along the
// master.
void set_friction(const CoulombContact& law, const VectorXd& z, const Eigen::Vector2d& way,
                  contact::ContactPoint& point) {
  contact::TangentialForce& f = *point.tangential;
  f.t = z.segment<2>(law.first + 1);
  f.u += way;
  f.slides = slides(law, z);
  const Eigen::Vector2d stretch = -f.c * f.t;
  point.elastic_slip = f.T * stretch;
  point.energy = 0.5 * point.c * point.p * point.p + 0.5 * f.c * f.t.squaredNorm();
  point.work = f.slides ? f.t.norm() * (f.u - stretch).norm() : 0;
  point.friction_power = f.slides ? f.t.norm() * point.slip.norm() : 0;
  point.stick.slides = f.slides;
  const Eigen::Vector2d e = f.on_face * (stretch - way);  // from where the node was found
  if (e.allFinite()) point.stick.e_u = e[0], point.stick.e_v = e[1];
}

}  // namespace

void UnilateralForces::set_forces(std::vector<PairContacts>& pairs) const {
  std::size_t c = 0;
  for (PairContacts& pair : pairs)
    for (contact::ContactPoint& point : pair.points) {
      if (!(point.c > 0)) continue;
      const Contact& contact = contacts_[c];
      const Displacement& moved = moved_[c];
      const Vector3d change = moved.answered;
      point.F += point.F_p * (z_[contact.first] - point.p + change[0]);
      point.F.reshaped() -= point.W * moved.k_V;
      if (point.p > 0) point.friction_power *= z_[contact.first] / point.p;
      point.p = z_[contact.first];
      point.energy = 0.5 * point.c * point.p * point.p;
      point.g_n += moved.way[0];
      if (point.tangential) {
        point.F.reshaped() += point.tangential->F_t *
                              (z_.segment<2>(contact.first + 1) - point.tangential->t + change.tail<2>());
        set_friction(laws_[c], z_, moved.way.tail<2>(), point);
      }
      point.f = contact::slave_force(point);
      ++c;
    }
}

}  // namespace elastogear::dynamics
