#pragma once
// The Newton iterations that find an equilibrium of a system, and the load steps up to the first one. Private
// to module dynamics.

#include <functional>
#include <string>
#include <vector>

#include "dynamics/integrator/problem.h"
#include "elastogear/dynamics/simulate.h"

namespace elastogear::dynamics {

struct Equilibrium {
  explicit Equilibrium(System& system) : problem(system), zero(Eigen::VectorXd::Zero(system.size())) {}

  Problem problem;
  double factor = 0;  // of the loads, in place of the time
  static constexpr double kUsualJump = 1e-5;
  double jump = kUsualJump;  // share of the forces by which contact may jump
  Eigen::VectorXd zero;
  std::vector<Eigen::VectorXd> resistance = {};  // sigma M of each body's joint coordinates, its diagonal
  Eigen::VectorXd unloaded_scale = {};           // of forces without load, the largest so far
  bool begins_near = false;                      // the search, at an equilibrium beside it
  int n_to_seek = 0;  // evaluations left in which contact need not be more exact than the imbalance asks
  double last_imbalance = 1;
  double least_norm = 0;  // of F, so far
  int n_in_vain = 0;      // iterations since then

  State state(ConstVector U) const { return {factor, U, zero, zero}; }
};

/// Asks at each evaluation; true throws Interrupted.
void request_stop(Equilibrium& at, const std::function<bool()>& stop);

/// J is created.
UniqueSNES make_snes(Equilibrium& at, UniqueMat& J);

/// The equilibrium at the present factor, from U on; false: none is found, and `trouble_of` says why.
bool find_equilibrium(Equilibrium& at, SNES snes, Vec U, RunSummary& summary);
std::string trouble_of(const Equilibrium& at);

/// The equilibria on the way to the whole load.
struct LoadPath {
  /// From the initial state, in this many steps of equal length.
  LoadPath(const System& system, int steps);

  UniqueVec U;
  Eigen::VectorXd good;               // the last equilibrium
  std::vector<PairContacts> pairs{};  // its contacts
  double first_step, step;
  double least_step;    // cut below that, there is no equilibrium
  double reached = -1;  // load factor; negative: not even the unloaded state
};

/// Tries one load step; false when it must be cut. Error when it cannot be cut any more.
bool advance(Equilibrium& at, SNES snes, LoadPath& path, RunSummary& summary);

}  // namespace elastogear::dynamics
