#include "dynamics/contact/unilateral_forces.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "dynamics/contact/complementarity.h"
#include "dynamics/contact/extrapolation.h"

namespace elastogear::dynamics {

using Eigen::MatrixXd;
using Eigen::VectorXd;

UnilateralForces::UnilateralForces(const std::vector<PairContacts>& pairs) {
  for (const PairContacts& pair : pairs)
    for (const contact::ContactPoint& point : pair.points) {
      if (!(point.c > 0)) continue;
      contacts_.push_back(&point);
      pair_.push_back(&pair);
    }
  const auto n = static_cast<Eigen::Index>(contacts_.size());
  C_.setZero(n, n);
  q_.resize(n);
  p_found_.resize(n);
  for (Eigen::Index i = 0; const contact::ContactPoint* point : contacts_) {
    q_[i] = point->g_n;
    p_found_[i] = point->p;
    C_(i, i) = point->c;
    ++i;
  }
  moved_.resize(contacts_.size());
}

void UnilateralForces::add(const ResponseNewton::Compliant& compliant, const VectorXd& missing) {
  const MatrixXd& R = compliant.R;
  Body body{{}, &R, missing, VectorXd::Zero(R.rows()), VectorXd::Zero(R.rows())};
  const Eigen::Matrix3d R_BW = compliant.R_WB.transpose();
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const contact::ContactPoint& point = *contacts_[c];
    for (int i = 0; i < point.n_local(); ++i) {
      const LocalNode local = local_node(point, i);
      if (pair_[c]->body[local.side] != static_cast<int>(compliant.body)) continue;
      const auto at = std::lower_bound(compliant.node.begin(), compliant.node.end(), local.node);
      body.touches.push_back({static_cast<Eigen::Index>(c), 3 * (at - compliant.node.begin()),
                              R_BW * point.F_p.col(i), R_BW * point.g_x.col(i),
                              R_BW * point.W.middleRows<3>(3 * i), R_BW * point.V.middleRows<3>(3 * i)});
    }
  }
  MatrixXd response = MatrixXd::Zero(R.rows(), C_.cols());  // R L_p
  for (const Touch& t : body.touches) response.col(t.contact) += R.middleCols<3>(t.row) * t.F_p;
  for (const Touch& t : body.touches) {
    const Eigen::RowVectorXd row = t.g_x.transpose() * response.middleRows<3>(t.row);
    C_.row(t.contact) += row;
    q_[t.contact] += t.g_x.dot(missing.segment<3>(t.row)) - row.dot(p_found_);
  }
  bodies_.push_back(std::move(body));
}

// The gaps that are left without forces p.
VectorXd UnilateralForces::gaps() const {
  VectorXd q = q_;
  for (const Body& body : bodies_) {
    if (body.turned.isZero(0)) continue;
    const VectorXd w = *body.R * body.turned;
    for (const Touch& t : body.touches) q[t.contact] += t.g_x.dot(w.segment<3>(t.row));
  }
  return q;
}

void UnilateralForces::set_changes() {
  for (Body& body : bodies_) {
    body.change = body.turned;
    for (const Touch& t : body.touches)
      body.change.segment<3>(t.row) += t.F_p * (p_[t.contact] - p_found_[t.contact]);
  }
}

// The change of the forces at unchanged p by the present displacements, dF = -(W k V' - F_p g_x' / c) dx; of
// all bodies, one after the other.
VectorXd UnilateralForces::turned_forces() {
  for (std::size_t c = 0; c < contacts_.size(); ++c) moved_[c] = {Along::Zero(contacts_[c]->k.rows())};
  for (const Body& body : bodies_) {
    const VectorXd dx = body.missing + *body.R * body.change;
    for (const Touch& t : body.touches) {
      Displacement& moved = moved_[static_cast<std::size_t>(t.contact)];
      moved.k_V += t.V.transpose() * dx.segment<3>(t.row);
      moved.closing += t.g_x.dot(dx.segment<3>(t.row));
    }
  }
  for (std::size_t c = 0; c < contacts_.size(); ++c) moved_[c].k_V = (contacts_[c]->k * moved_[c].k_V).eval();
  VectorXd all = VectorXd::Zero(all_turned().size());
  Eigen::Index first = 0;
  for (const Body& body : bodies_) {
    for (const Touch& t : body.touches) {
      const auto c = static_cast<std::size_t>(t.contact);
      all.segment<3>(first + t.row) += t.F_p * (moved_[c].closing / contacts_[c]->c) - t.W * moved_[c].k_V;
    }
    first += body.turned.size();
  }
  return all;
}

VectorXd UnilateralForces::all_turned() const {
  Eigen::Index size = 0;
  for (const Body& body : bodies_) size += body.turned.size();
  VectorXd all(size);
  for (Eigen::Index first = 0; const Body& body : bodies_) {
    all.segment(first, body.turned.size()) = body.turned;
    first += body.turned.size();
  }
  return all;
}

void UnilateralForces::turn(const VectorXd& all) {
  for (Eigen::Index first = 0; Body & body : bodies_) {
    body.turned = all.segment(first, body.turned.size());
    first += body.turned.size();
  }
}

void UnilateralForces::do_not_turn() {
  for (Body& body : bodies_) body.turned.setZero();
  for (std::size_t c = 0; c < contacts_.size(); ++c) moved_[c] = {Along::Zero(contacts_[c]->k.rows())};
}

// Forces turn, and points move, while gaps close: both are brought together by turns, with the extrapolation
// of D. G. Anderson (J. ACM 12, 1965, 547-560). At an edge forces may turn by any angle; there the directions
// stay those that were found.
bool UnilateralForces::solve() {
  constexpr int kMostRounds = 25;
  constexpr double kTolerance = 1e-10;  // of the forces
  do_not_turn();
  std::vector<bool> likely;
  for (const contact::ContactPoint* point : contacts_) likely.push_back(point->p > 0 || point->g_n < 0);
  Extrapolation extrapolation;
  bool turns = true;
  for (int round = 0; round < kMostRounds; ++round) {
    const std::optional<VectorXd> p = solve_complementarity(C_, gaps(), likely);
    if (!p) return false;
    p_ = *p;
    for (std::size_t i = 0; i < likely.size(); ++i) likely[i] = p_[static_cast<Eigen::Index>(i)] > 0;
    set_changes();
    if (p_.size() == 0 || !turns) break;
    const VectorXd before = all_turned(), turned = turned_forces();
    turn(turned);
    if ((turned - before).cwiseAbs().maxCoeff() <= kTolerance * p_.maxCoeff()) break;
    turns = round < kMostRounds - 2;
    if (turns)
      turn(extrapolation.next(before, turned));
    else
      do_not_turn();
  }
  return true;
}

void UnilateralForces::set_forces(std::vector<PairContacts>& pairs) const {
  std::size_t c = 0;
  for (PairContacts& pair : pairs)
    for (contact::ContactPoint& point : pair.points) {
      if (!(point.c > 0)) continue;
      const double p = p_[static_cast<Eigen::Index>(c)];
      point.F += point.F_p * (p - point.p + moved_[c].closing / point.c);
      point.F.reshaped() -= point.W * moved_[c].k_V;
      point.f = contact::slave_force(point);
      point.p = p;
      ++c;
    }
}

}  // namespace elastogear::dynamics
