// Contacts of a state, and the static responses of residual flexibility to them.
#include <algorithm>
#include <utility>

#include "elastogear/dynamics/system.h"

namespace elastogear::dynamics {
namespace {

constexpr double kForceResidual = 1e-10;    // of contact forces against those of the static responses
constexpr double kRoundoffResidual = 1e-7;  // that may be roundoff of gaps, where it falls no further
constexpr double kSmallResidual = 1e-3;     // whose square is negligible
constexpr double kJump = 0.02;    // of forces where a node passes from face to face, that has no solution
constexpr int kMostTrials = 30;   // until they fit
constexpr int kMostHalvings = 5;  // of the way to the next trial, while it would be worse

}  // namespace

const ContactState& System::contacts(double time, ConstVector U, ConstVector V) {
  if (U_of_state_ && time == time_of_state_ && *U_of_state_ == U && V_of_state_ == V) return state_;
  U_of_state_.reset();
  std::vector<contact::SurfaceMotion> motion;
  state_.surface.resize(bodies_.size());
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    motion.push_back(surface_motion(b, time, U, V));
    const bool first = state_.surface[b].x_B.cols() == 0 && bodies_[b].in_contact;
    if (first) state_.surface[b].x_B = bodies_[b].eq.body->surface.X;
    state_.surface[b].r_WB = motion[b].r_WB;
    state_.surface[b].R_WB = motion[b].R_WB;
  }
  if (residual_contact_.any() && time != time_of_state_) residual_contact_.predict(time);
  detect(motion);
  if (residual_contact_.any()) find_static_responses(motion);
  U_of_state_ = U;
  V_of_state_ = V;
  time_of_state_ = time;
  return state_;
}

// Detects the contacts of the bodies with the residual displacements of the last trial.
void System::detect(const std::vector<contact::SurfaceMotion>& motion) {
  state_.pair.clear();
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    const int a = pairs_[p].body[0], b = pairs_[p].body[1];
    const std::array<contact::ResidualDisplacement, 2> residual{residual_contact_.residual(a),
                                                                residual_contact_.residual(b)};
    state_.pair.push_back({{a, b}, detectors_[p].detect(motion[a], motion[b], residual)});
    place_touched(p);
  }
  residual_contact_.seen();
  state_.force = nodal_forces(state_.pair, state_.surface);
}

// Detects contact with the present static responses and returns the force residual.
ResidualContact::ForceResidual System::force_residual_now(const std::vector<contact::SurfaceMotion>& motion) {
  detect(motion);
  return residual_contact_.force_residual(state_.force);
}

// Solves for contact forces and static responses by Newton's method (docs/theory.md, Eq. (6.21)); a step that
// makes the force residual larger is halved.
void System::find_static_responses(const std::vector<contact::SurfaceMotion>& motion) {
  auto force_residual = residual_contact_.force_residual(state_.force);
  for (int trial = 0; force_residual.relative > kForceResidual && trial < kMostTrials; ++trial) {
    if (force_residual.relative < kSmallResidual &&
        residual_contact_.linear_step(state_.pair, state_.surface, state_.force)) {
      state_.force = nodal_forces(state_.pair, state_.surface);
      force_residual = {};
      continue;
    }
    residual_contact_.newton_step(state_.pair, state_.surface, state_.force);
    const auto before = std::exchange(force_residual, force_residual_now(motion));
    if (force_residual.relative < kRoundoffResidual && force_residual.absolute > 0.1 * before.absolute)
      force_residual = {};
    for (int half = 0; force_residual.absolute > before.absolute && half < kMostHalvings; ++half, ++trial) {
      residual_contact_.backtrack();
      force_residual = force_residual_now(motion);
    }
  }
  // A node is held at an edge by a jump of its force: the force of its static response lies between the
  // values on both sides.
  if (force_residual.relative > kForceResidual && force_residual.relative < kJump) {
    residual_contact_.take_forces_of_response(state_.surface, state_.force);
    force_residual = {};
  }
  state_.balanced = force_residual.relative <= kForceResidual;
}

// Sets the positions of the nodes that contact touches; those of the others stay undeformed.
void System::place_touched(std::size_t p) {
  const PairContacts& pair = state_.pair[p];
  for (const contact::ContactPoint& point : pair.points)
    for (int i = 0; i < kLocalNodes; ++i) {
      const auto [side, node] = local_node(point, i);
      state_.surface[pair.body[side]].x_B.col(node) = detectors_[p].position(side, node);
    }
}

double System::depth_share(double time, ConstVector U, ConstVector V) {
  double share = 0;
  const ContactState& contact = contacts(time, U, V);
  for (std::size_t p = 0; p < pairs_.size(); ++p)
    for (const contact::ContactPoint& point : contact.pair[p].points)
      share = std::max(share, -point.g_n / detectors_[p].settings().depth);
  return share;
}

}  // namespace elastogear::dynamics
