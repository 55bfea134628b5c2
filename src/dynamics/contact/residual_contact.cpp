#include "elastogear/dynamics/residual_contact.h"

#include <algorithm>
#include <cmath>

#include "dynamics/contact/response_newton.h"

namespace elastogear::dynamics {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// share_a a + share_b b
NodalForces sum(const NodalForces& a, double share_a, const NodalForces& b, double share_b) {
  NodalForces result;
  std::set_union(a.node.begin(), a.node.end(), b.node.begin(), b.node.end(), std::back_inserter(result.node));
  result.f_B.setZero(3, static_cast<Eigen::Index>(result.node.size()));
  const auto add = [&](const NodalForces& part, double factor) {
    for (std::size_t i = 0; i < part.node.size(); ++i) {
      const auto at = std::lower_bound(result.node.begin(), result.node.end(), part.node[i]);
      result.f_B.col(at - result.node.begin()) += factor * part.f_B.col(static_cast<Eigen::Index>(i));
    }
  };
  add(a, share_a);
  add(b, share_b);
  return result;
}

NodalForces mean(const NodalForces& a, const NodalForces& b, double share) {
  return sum(a, share, b, 1 - share);
}
NodalForces difference(const NodalForces& a, const NodalForces& b) { return sum(a, 1, b, -1); }

}  // namespace

ResidualContact::ResidualContact(const std::vector<const model::ElasticBody*>& bodies)
    : flexibility_(bodies.size()), left_(bodies.size()), change_(bodies.size(), 0) {
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (!bodies[b]->flexibility.empty()) flexibility_[b].emplace(*bodies[b]);
}

bool ResidualContact::any() const {
  return std::any_of(flexibility_.begin(), flexibility_.end(), [](const auto& f) { return f.has_value(); });
}

contact::ResidualDisplacement ResidualContact::residual(std::size_t b) {
  if (!has_flexibility(b)) return {};
  ResidualFlexibility& R = *flexibility_[b];
  return {[&R](int node) { return R.displacement(node); }, R.bound(R.forces()), change_[b]};
}

void ResidualContact::seen() { std::fill(change_.begin(), change_.end(), 0); }

MatrixXd ResidualContact::among(std::size_t b, const std::vector<int>& node) {
  return has_flexibility(b) ? flexibility_[b]->among(node) : MatrixXd();
}

ResidualContact::ForceResidual ResidualContact::force_residual(const std::vector<NodalForces>& found) const {
  double missing = 0, all = 0;
  for (std::size_t b = 0; b < found.size(); ++b) {
    if (!has_flexibility(b)) continue;
    missing += difference(found[b], flexibility_[b]->forces()).f_B.squaredNorm();
    all += found[b].f_B.squaredNorm();
  }
  return {std::sqrt(missing), missing > 0 ? std::sqrt(missing / std::max(all, missing)) : 0};
}

void ResidualContact::respond_to(std::size_t b, const NodalForces& forces) {
  ResidualFlexibility& R = *flexibility_[b];
  change_[b] += R.bound(difference(forces, R.forces()));
  R.set_forces(forces);
}

// With w = R (f - L k lambda), lambda = L_V' (w - w_now) of all bodies: (I + H k) lambda = L_V' (R f -
// w_now), H = L_V' R L. docs/theory.md, Eq. (6.21).
VectorXd ResidualContact::step(const std::vector<PairContacts>& pairs,
                               const std::vector<contact::SurfaceState>& surfaces,
                               const std::vector<NodalForces>& found) {
  ResponseNewton newton(pairs);
  for (std::size_t b = 0; b < found.size(); ++b) {
    if (!has_flexibility(b)) continue;
    const std::vector<int>& node = found[b].node;
    const MatrixXd& R = flexibility_[b]->among(node);
    VectorXd missing = R * found[b].f_B.reshaped();
    for (std::size_t i = 0; i < node.size(); ++i)
      missing.segment<3>(static_cast<Eigen::Index>(3 * i)) -= displacement(b, node[i]);
    newton.add({b, surfaces[b].R_WB, node, R}, missing);
  }
  const VectorXd lambda = newton.solve();
  for (std::size_t b = 0, i = 0; b < found.size(); ++b) {
    if (!has_flexibility(b)) continue;
    NodalForces next = found[b];
    next.f_B.reshaped() -= newton.force_change(i++, lambda);
    left_[b] = flexibility_[b]->forces();
    respond_to(b, next);
  }
  return lambda;
}

void ResidualContact::newton_step(const std::vector<PairContacts>& pairs,
                                  const std::vector<contact::SurfaceState>& surfaces,
                                  const std::vector<NodalForces>& found) {
  step(pairs, surfaces, found);
}

void ResidualContact::backtrack() {
  for (std::size_t b = 0; b < flexibility_.size(); ++b)
    if (has_flexibility(b)) respond_to(b, mean(flexibility_[b]->forces(), left_[b], 0.5));
}

bool ResidualContact::linear_step(std::vector<PairContacts>& pairs,
                                  const std::vector<contact::SurfaceState>& surfaces,
                                  const std::vector<NodalForces>& found) {
  for (const PairContacts& pair : pairs)
    for (const contact::ContactPoint& point : pair.points)
      if (point.V_dot.cols() > 0) return false;
  const VectorXd lambda = step(pairs, surfaces, found);
  Eigen::Index column = 0;
  for (PairContacts& pair : pairs)
    for (contact::ContactPoint& point : pair.points) {
      const VectorXd change = lambda.segment(column, point.W.cols());
      point.F.reshaped() -= point.W * (point.k * change);
      point.f = point.F.col(0);
      point.g_n += change[0];
      point.energy = 0.5 * point.k(0, 0) * point.g_n * point.g_n;
      column += point.W.cols();
    }
  return true;
}

void ResidualContact::take_forces_of_response(const std::vector<contact::SurfaceState>& surfaces,
                                              std::vector<NodalForces>& found) const {
  for (std::size_t b = 0; b < found.size(); ++b) {
    if (!has_flexibility(b)) continue;
    found[b] = flexibility_[b]->forces();
    found[b].x_B = surfaces[b].x_B(Eigen::all, found[b].node);
  }
}

void ResidualContact::predict(double time) {
  if (before_.forces.empty() || !(last_.time > before_.time)) return;
  const double share = (time - before_.time) / (last_.time - before_.time);
  for (std::size_t b = 0; b < flexibility_.size(); ++b)
    if (has_flexibility(b) && last_.forces[b].node == before_.forces[b].node)
      respond_to(b, mean(last_.forces[b], before_.forces[b], share));
}

void ResidualContact::accept(double time) {
  before_ = std::move(last_);
  last_ = {time, {}};
  for (const auto& flexibility : flexibility_)
    last_.forces.push_back(flexibility ? flexibility->forces() : NodalForces{});
}

double ResidualContact::energy(std::size_t b) {
  if (!has_flexibility(b)) return 0;
  ResidualFlexibility& R = *flexibility_[b];
  double energy = 0;
  for (std::size_t i = 0; i < R.forces().node.size(); ++i)
    energy += 0.5 * R.forces().f_B.col(static_cast<Eigen::Index>(i)).dot(R.displacement(R.forces().node[i]));
  return energy;
}

void ResidualContact::serialize(Archive& archive) {
  const auto visit = [&](NodalForces& forces) {
    archive(forces.node);
    archive(forces.f_B);
  };
  for (std::size_t b = 0; b < flexibility_.size(); ++b) {
    if (!has_flexibility(b)) continue;
    NodalForces forces = flexibility_[b]->forces();
    visit(forces);
    if (archive.is_loading()) flexibility_[b]->set_forces(forces);
  }
  for (Accepted* accepted : {&last_, &before_}) {
    archive(accepted->time);
    archive.each(accepted->forces, visit);
  }
}

}  // namespace elastogear::dynamics
