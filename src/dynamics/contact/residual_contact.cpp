#include "dynamics/contact/residual_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "dynamics/contact/response_newton.h"
#include "dynamics/contact/unilateral_forces.h"

namespace elastogear::dynamics {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kForceResidual = 1e-10;    // of contact forces against those of the static responses
constexpr double kRoundoffResidual = 1e-7;  // that may be roundoff of gaps, where it falls no further
constexpr double kSmallResidual = 1e-3;     // whose square is negligible
constexpr double kJump = 0.02;  // of forces where a node passes from face to face, that has no solution
constexpr double kForceTolerance = 1e-8;  // of contact forces without a penalty, as of all forces in balance
constexpr double kMovingTolerance = 1e-10;   // of those of points that move over faces, and turn with them
constexpr double kObservedTolerance = 1e-6;  // of those of states that are read and not solved for
constexpr double kMovingShare = 0.1;         // of the tolerance asked for, of those of points that move
constexpr double kTurningTolerance = 1e-10;  // of forces that turn as gaps close
constexpr double kTurningShare = 0.01;       // of the tolerance of contact forces, of those that turn
constexpr double kFirstRate = 1e-3;          // by which a first change of forces is expected to fall
constexpr double kBend = 0.1;     // and by this times itself, where points move and forces turn with it
constexpr int kFullTrials = 12;   // before they go half of the way, as nodes jump between faces
constexpr int kMostTrials = 40;   // until they fit
constexpr int kMostHalvings = 5;  // of the way to the next trial, while it would be worse

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
// Without the nodes that carry no force, unless they are among `before`: the active set
// alternates, and a new set of nodes costs more than a few zeros.
NodalForces loaded(const NodalForces& all, const std::vector<int>& before) {
  constexpr std::size_t kMostZeros = 3;  // nodes kept for each one loaded
  NodalForces result;
  std::vector<Eigen::Index> columns, kept;
  for (std::size_t i = 0; i < all.node.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    const bool has_force = !all.f_B.col(column).isZero(0);
    if (has_force) columns.push_back(column);
    if (has_force || std::binary_search(before.begin(), before.end(), all.node[i])) kept.push_back(column);
  }
  if (kept.size() <= kMostZeros * columns.size()) columns = kept;
  for (Eigen::Index column : columns) result.node.push_back(all.node[static_cast<std::size_t>(column)]);
  result.f_B = all.f_B(Eigen::all, columns);
  return result;
}

NodalForces difference(const NodalForces& a, const NodalForces& b) { return sum(a, 1, b, -1); }

// Forces of local minimum-gap points turn as these move, far on flat gaps: Newton's method of the system,
// whose tangent is that of settled points, needs them more exactly. asked: by that method.
double tolerance(const ContactState& state, ForceAccuracy accuracy, double asked) {
  if (accuracy == ForceAccuracy::observed) return std::max(kObservedTolerance, asked);
  const auto moves = [](const contact::ContactPoint& point) {
    return point.n_slave() > 1 && point.area == 0;
  };
  const bool any = std::any_of(state.pair.begin(), state.pair.end(), [&](const PairContacts& pair) {
    return std::any_of(pair.points.begin(), pair.points.end(), moves);
  });
  return any ? std::max(kMovingTolerance, kMovingShare * asked) : std::max(kForceTolerance, asked);
}

}  // namespace

ResidualContact::ResidualContact(const SystemModel& model)
    : flexibility_(model.bodies.size()), left_(model.bodies.size()), change_(model.bodies.size(), 0) {
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    if (const model::ElasticBody& body = *model.bodies[b].eq.body; !body.flexibility.empty())
      flexibility_[b].emplace(body);
}

bool ResidualContact::any() const {
  return std::any_of(flexibility_.begin(), flexibility_.end(), [](const auto& f) { return f.has_value(); });
}

contact::ResidualDisplacement ResidualContact::residual(std::size_t b) {
  if (!has_flexibility(b)) return {};
  ResidualFlexibility& R = *flexibility_[b];
  return {[this, b](int node) { return displacement(b, node); }, R.bound(R.forces()) + R.lag_bound(),
          change_[b]};
}

void ResidualContact::seen() { std::fill(change_.begin(), change_.end(), 0); }

const MatrixXd& ResidualContact::among(std::size_t b, const std::vector<int>& node) {
  static const MatrixXd kNone;
  return has_flexibility(b) ? flexibility_[b]->among(node) : kNone;
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

std::vector<VectorXd> ResidualContact::displacements(const ContactState& state) {
  std::vector<VectorXd> w(state.force.size());
  for (std::size_t b = 0; b < w.size(); ++b) {
    if (!has_flexibility(b)) continue;
    const std::vector<int>& nodes = state.force[b].node;
    w[b].resize(3 * static_cast<Eigen::Index>(nodes.size()));
    for (Eigen::Index i = 0; int node : nodes) w[b].segment<3>(3 * i++) = displacement(b, node);
  }
  return w;
}

// R f - w of the forces found and the static response in place, beside what is left of former forces.
VectorXd ResidualContact::missing_response(std::size_t b, const NodalForces& found, const MatrixXd& R,
                                           const VectorXd& w) {
  VectorXd missing = R * found.f_B.reshaped() - w;
  for (std::size_t i = 0; i < found.node.size(); ++i)
    missing.segment<3>(static_cast<Eigen::Index>(3 * i)) += flexibility_[b]->lag(found.node[i]);
  return missing;
}

// With w = R (f - L k lambda), lambda = L_V' (w - w_now) of all bodies: (I + H k) lambda = L_V' (R f -
// w_now), H = L_V' R L. docs/theory, Eq. (6.21).
VectorXd ResidualContact::newton_step(const ContactState& state) {
  const std::vector<NodalForces>& found = state.force;
  const std::vector<VectorXd> w = displacements(state);
  ResponseNewton newton(state.pair);
  for (std::size_t b = 0; b < found.size(); ++b) {
    if (!has_flexibility(b)) continue;
    const std::vector<int>& node = found[b].node;
    const MatrixXd& R = flexibility_[b]->among(node);
    newton.add({b, state.surface[b].R_WB, node, R}, missing_response(b, found[b], R, w[b]));
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

void ResidualContact::backtrack() {
  for (std::size_t b = 0; b < flexibility_.size(); ++b)
    if (has_flexibility(b)) respond_to(b, mean(flexibility_[b]->forces(), left_[b], 0.5));
}

bool ResidualContact::linear_step(ContactState& state) {
  for (const PairContacts& pair : state.pair)
    for (const contact::ContactPoint& point : pair.points)
      if (point.V_dot.cols() > 0) return false;
  const VectorXd lambda = newton_step(state);
  Eigen::Index column = 0;
  for (PairContacts& pair : state.pair)
    for (contact::ContactPoint& point : pair.points) {
      const VectorXd change = lambda.segment(column, point.W.cols());
      point.F.reshaped() -= point.W * (point.k * change);
      point.f = contact::slave_force(point);
      point.g_n += change[0];
      point.energy = 0.5 * point.k(0, 0) * point.g_n * point.g_n;
      column += point.W.cols();
    }
  state.force = nodal_forces(state.pair, state.surface);
  return true;
}

void ResidualContact::take_forces_of_response(ContactState& state) const {
  for (std::size_t b = 0; b < state.force.size(); ++b) {
    if (!has_flexibility(b)) continue;
    state.force[b] = flexibility_[b]->forces();
    state.force[b].x_B = state.surface[b].x_B(Eigen::all, state.force[b].node);
  }
}

void ResidualContact::solve(ContactState& state, const std::function<void()>& detect) {
  ForceResidual residual = force_residual(state.force);
  for (int trial = 0; residual.relative > kForceResidual && trial < kMostTrials; ++trial) {
    if (residual.relative < kSmallResidual && linear_step(state)) {
      residual = {};
      continue;
    }
    newton_step(state);
    detect();
    const ForceResidual before = std::exchange(residual, force_residual(state.force));
    const bool may_be_roundoff = residual.relative < kRoundoffResidual || residual.absolute < roundoff_;
    if (may_be_roundoff && residual.absolute > 0.1 * before.absolute) residual = {};
    for (int half = 0; residual.absolute > before.absolute && half < kMostHalvings; ++half, ++trial) {
      backtrack();
      detect();
      residual = force_residual(state.force);
    }
  }
  // A node is held at an edge by a jump of its force: the force of its static response lies between the
  // values on both sides.
  if (residual.relative > kForceResidual && residual.relative < kJump) {
    take_forces_of_response(state);
    residual = {};
  }
  state.balanced = residual.relative <= kForceResidual;
}

std::optional<ResidualContact::Change> ResidualContact::close_gaps(ContactState& state, double share) {
  const std::vector<VectorXd> w = displacements(state);
  UnilateralForces unilateral(state.pair);
  for (std::size_t b = 0; b < state.force.size(); ++b) {
    if (!has_flexibility(b)) continue;
    const std::vector<int>& node = state.force[b].node;
    const MatrixXd& R = flexibility_[b]->among(node);
    unilateral.add({b, state.surface[b].R_WB, node, R}, missing_response(b, state.force[b], R, w[b]));
  }
  if (!unilateral.solve(std::max(kTurningTolerance, kTurningShare * allowed_))) return {};
  const bool slides_anew = unilateral.slides_anew(), bends = unilateral.takes_turning_in();
  unilateral.set_forces(state.pair);
  double missing = 0, all = 0;
  for (std::size_t b = 0, i = 0; b < state.force.size(); ++b) {
    if (!has_flexibility(b)) continue;
    NodalForces next = state.force[b];
    next.f_B.reshaped() += unilateral.force_change(i++);
    missing += difference(next, flexibility_[b]->forces()).f_B.squaredNorm();
    all += next.f_B.squaredNorm();
    const NodalForces& now = flexibility_[b]->forces();
    respond_to(b, loaded(share < 1 ? mean(next, now, share) : next, now.node));
  }
  if (missing == 0) return Change{0, slides_anew, bends};
  return Change{std::sqrt(missing) / std::max(std::sqrt(std::max(all, missing)), least_force(state)),
                slides_anew, bends};
}

// Of smaller forces no more is asked for: roundoff of positions changes them by the force residual. N.
double ResidualContact::least_force(const ContactState& state) const {
  double least = 0;
  for (std::size_t b = 0; b < state.force.size(); ++b) {
    if (!has_flexibility(b) || state.force[b].node.empty()) continue;
    const double roundoff = std::numeric_limits<double>::epsilon() * state.force[b].x_B.cwiseAbs().maxCoeff();
    least = std::max(least, roundoff / (flexibility_[b]->largest() * kForceResidual));
  }
  return least;
}

void ResidualContact::solve_unilateral(ContactState& state, ForceAccuracy accuracy,
                                       const std::function<void()>& detect) {
  std::optional<Change> change;
  double before = 0;
  const double allowed = allowed_ = std::max(sought_, tolerance(state, accuracy, asked_));
  bool settled = false;
  for (int trial = 0; !settled && trial < kMostTrials; ++trial) {
    change = close_gaps(state, trial < kFullTrials ? 1 : 0.5);
    if (!change) break;
    const double now = change->forces;
    // The next change of the forces is expected to fall as this one did.
    const double first_rate = change->bends ? std::min(kFirstRate, kBend * now) : kFirstRate;
    expected_ = now * (trial > 0 ? std::min(1.0, now / before) : first_rate);
    const bool is_roundoff = trial > 0 && now < kRoundoffResidual && now > 0.1 * before;
    const bool is_exact = expected_ <= allowed && now < kJump;
    settled = (is_exact || is_roundoff) && !change->slides_anew;
    before = now;
    if (!settled) detect();
  }
  state.balanced = change && change->forces < kJump;
  for (PairContacts& pair : state.pair)
    std::erase_if(pair.points,
                  [](const contact::ContactPoint& point) { return point.c > 0 && point.p == 0; });
  state.force = nodal_forces(state.pair, state.surface);
}

void ResidualContact::predict(double time) {
  if (before_.forces.empty() || !(last_.time > before_.time)) return;
  const double share = (time - before_.time) / (last_.time - before_.time);
  for (std::size_t b = 0; b < flexibility_.size(); ++b)
    if (has_flexibility(b) && last_.forces[b].node == before_.forces[b].node)
      respond_to(b, mean(last_.forces[b], before_.forces[b], share));
}

void ResidualContact::set_point(std::size_t b, body::Moduli moduli, const body::StepPoint& at) {
  if (has_flexibility(b)) change_[b] += flexibility_[b]->set_point(moduli, at);
}

void ResidualContact::accept(double time) {
  before_ = std::move(last_);
  last_ = {time, {}};
  for (const auto& flexibility : flexibility_)
    last_.forces.push_back(flexibility ? flexibility->forces() : NodalForces{});
  for (auto& flexibility : flexibility_)
    if (flexibility) flexibility->accept();
}

bool ResidualContact::begin_equilibrium_search(double tolerance) {
  sought_ = tolerance;
  return expected_ > std::max(tolerance, kMovingTolerance);
}

double ResidualContact::energy(std::size_t b) { return has_flexibility(b) ? flexibility_[b]->energy() : 0; }
double ResidualContact::loss(std::size_t b) const { return has_flexibility(b) ? flexibility_[b]->loss() : 0; }

double ResidualContact::work(const std::vector<NodalForces>& then, const std::vector<NodalForces>& now) {
  double work = 0;
  for (std::size_t b = 0; b < flexibility_.size() && !last_.forces.empty(); ++b) {
    if (!has_flexibility(b)) continue;
    const NodalForces force = mean(then[b], now[b], 0.5);
    if (flexibility_[b]->creeps()) {
      for (std::size_t i = 0; i < force.node.size(); ++i)
        work += flexibility_[b]
                    ->change_since(last_.forces[b], force.node[i])
                    .dot(force.f_B.col(static_cast<Eigen::Index>(i)));
      continue;
    }
    const NodalForces change = difference(flexibility_[b]->forces(), last_.forces[b]),
                      all = sum(change, 1, force, 0);
    const VectorXd dw = flexibility_[b]->among(all.node) * all.f_B.reshaped();
    work += dw.dot(sum(change, 0, force, 1).f_B.reshaped());
  }
  return work;
}

void ResidualContact::serialize(Archive& archive) {
  const auto visit = [&](NodalForces& forces) {
    archive(forces.node);
    archive(forces.f_B);
  };
  for (std::size_t b = 0; b < flexibility_.size(); ++b) {
    if (!has_flexibility(b)) continue;
    flexibility_[b]->serialize(archive);
  }
  for (Accepted* accepted : {&last_, &before_}) {
    archive(accepted->time);
    archive.each(accepted->forces, visit);
  }
}

}  // namespace elastogear::dynamics
