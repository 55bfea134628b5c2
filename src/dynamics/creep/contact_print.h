#pragma once
// What the nodes of a viscoelastic body remember that are out of contact (docs/theory, section 3.8).
// Without a force the states of all of them go on by the same matrix of the step, one for each law, so that
// they and all that is linear or quadratic in them go on together, however many they are.

#include <Eigen/Core>
#include <map>
#include <vector>

#include "elastogear/base/archive.h"
#include "elastogear/body/creep.h"

namespace elastogear::dynamics {

/// States are kept as they were when they were gathered last. A state, or the displacement of a node by all
/// of them, is what was gathered times the product of the steps since then.
class ContactPrint {
 public:
  explicit ContactPrint(const body::CreepLaws& laws);

  /// States of forces of the nodes, N, as gathered.
  const std::map<int, body::CreepState>& force() const { return force_; }
  /// What was gathered at the start of the step; at the point of the step.
  body::CreepState at_start(const body::CreepState& gathered) const { return product(gathered, start_); }
  body::CreepState at_point(const body::CreepState& gathered) const { return product(gathered, point_); }
  /// psi_j - f at the point, summed up over the laws.
  Eigen::Vector3d lag(const body::CreepState& gathered) const;

  /// From here on the point is that of the laws.
  void set_point(const body::CreepLaws& laws);
  /// The point becomes the start of the next step.
  void accept() { start_ = point_; }

  /// J: twice the energy that springs keep between these nodes at the point, and what dashpots take there
  /// within the step. Eqs. (3.28) and (3.29).
  double twice_energy(const body::CreepLaws& laws) const;
  double loss(const body::CreepLaws& laws) const;

  struct Lag {
    double all = 0, change = 0;  // by now; since remember_lag()
  };
  Lag lag_product() const;  ///< J: h'D h of the lags h of all forces
  Lag lag_bound() const;    ///< m: no node lags farther, by what displaced it when it was taken in
  void remember_lag() { last_lag_ = lag_weights(); }

  /// Gathers the states anew, at the start of a step, and forgets nodes whose states are below `least`, N.
  void renew(double least);
  /// A node that is taken in right after renew(): its state, and its displacements by the forces that were
  /// there before, by those of all nodes that are taken in together, and by all forces of the body.
  struct Entry {
    int node;
    body::CreepState force, by_print, by_entries, by_all;
  };
  void add(const Entry& entry);
  void serialize(Archive& archive);

 private:
  using Matrices = std::vector<Eigen::MatrixXd>;  // (1 + n) square, one of each law

  body::CreepState product(const body::CreepState& gathered, const Matrices& by) const;
  Eigen::VectorXd lag_weights() const;

  Eigen::Index n_each_ = 0;                // 1 + n
  std::map<int, body::CreepState> force_;  // by node
  Matrices start_, step_, point_;          // from the gathering to the start, from there to the point, both
  Matrices gram_;                          // sum of F_a' D_j(a, b) F_b of what was gathered
  Eigen::VectorXd last_lag_;               // weights of the columns in the lag that is remembered
  Eigen::VectorXd largest_;                // m, of each column of the displacements of nodes taken in
};

}  // namespace elastogear::dynamics
