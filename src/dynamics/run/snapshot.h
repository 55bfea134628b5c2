#pragma once
// The state of a system at one time as results see it, and its energy ledger.

#include <array>

#include "elastogear/dynamics/system.h"
#include "elastogear/model/result.h"

namespace elastogear::dynamics {

/// J, in penalties and in the half-spaces of stations, but for static responses of bodies.
double stored_in_contact(const ContactState& contact);

/// Bodies, pairs, bushings, loads, sensors and stored energies; dissipated, work and balance stay zero.
model::Snapshot snapshot(System& system, const State& x);

/// Completes the energies of successive snapshots. Over one step damping takes dt q'_m.D_r q'_m with the mean
/// velocity q'_m, which is exact for the midpoint rule (rho_inf = 1), second order otherwise. Loads and
/// friction of joints likewise, and the dampers of bushings; drives and loads at markers by the mean of their
/// forces at both ends. Of viscoelastic materials Eq. (3.26), which is exact for the midpoint rule. The
/// weight's work is exact; while gravity grows it has its mean over the step. Equilibria
/// at growing load factors (analysis: static) are entered in the same distance.
/// docs/theory, Eq. (7.2).
class EnergyLedger {
 public:
  void enter(const System& system, model::Snapshot& snapshot);
  bool has_entries() const { return !bodies_.empty(); }
  void serialize(Archive& archive);

 private:
  void enter_joint(const System::Body& body, const model::BodyState& now, const model::BodyState& before,
                   const std::array<double, 2>& times);

  void enter_relaxation(const System& system, std::size_t b, const model::BodyState& now);
  void enter_weight(const System& system, const model::Snapshot& now);
  void enter_markers(const MarkerForces& forces, const model::Snapshot& now);

  double stored_0_ = 0, dissipated_ = 0, work_ = 0;
  double weight_ = 0;  // J, potential of the full weight in the snapshot before
  double time_ = 0;
  double relaxation_ = 0;                 // J, part of dissipated_: of the elastic coordinates
  std::vector<model::BodyState> bodies_;  // of the snapshot before; empty: none yet
  std::vector<model::BushingState> bushings_;
  std::vector<model::LoadState> loads_;
};

}  // namespace elastogear::dynamics
