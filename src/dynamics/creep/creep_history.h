#pragma once
// History of the forces on a viscoelastic body, by which its residual displacement creeps (docs/theory,
// section 3.8): states of the nodes that carry a force or did so lately, step by step; the print of all
// others together.

#include <Eigen/Core>
#include <functional>
#include <map>
#include <vector>

#include "dynamics/creep/contact_print.h"
#include "elastogear/base/archive.h"
#include "elastogear/body/creep.h"
#include "elastogear/dynamics/contact_loads.h"
#include "elastogear/model/relaxed_state.h"

namespace elastogear::dynamics {

/// Nodes are those of the surface. What a step takes grows with the nodes that carry a force, or did so
/// within the last steps, and with those whose displacements are asked for, however many have borne one
/// before. By linearity the history of a node is the sum of what it has in the print and of what came after.
class CreepHistory {
 public:
  CreepHistory(const std::vector<body::RelaxationLaw>& laws, std::size_t n_nodes);

  /// What the history asks of its body.
  struct Response {
    /// D_j(a, b) of all laws times states of forces on node b: displacement of node a.
    std::function<body::CreepState(int a, int b, const body::CreepState& force)> displaced_by;
    /// D_j f of a node by the forces at the point, 3 x n_laws.
    std::function<Eigen::Matrix3Xd(int node)> displaced;
  };

  const body::CreepLaws& laws() const { return laws_; }
  bool empty() const { return recent_.empty() && print_.force().empty(); }
  /// m: sum over the laws of D_j (psi_j - f) at the point of the step, for f = 0; of D_j psi_j at its start.
  Eigen::Vector3d lag(int node, const Response& response);
  Eigen::Vector3d displaced_at_start(int node, const Response& response);

  struct Lag {
    double product = 0, product_change = 0;  // J: bounds of h'D h of the lags h of the forces
    double largest = 0, largest_change = 0;  // m: of nodes that have been loaded
  };
  /// From here on states are at this point of a step. Returns how far nodes lag, and the change by that.
  Lag set_point(body::Moduli moduli, const body::StepPoint& at, const Response& response);
  /// These forces are those at the end of the step: it becomes the start of the next one. To be followed by
  /// set_point at that start, and that by gather().
  void accept(const NodalForces& forces, const Response& response);
  /// From time to time puts nodes into the print that have been out of contact for some steps, and forgets
  /// the displacements of nodes that nobody has asked for.
  void gather(const Response& response);

  /// J: twice the energy that springs keep by these forces at the point, but for what does not creep.
  double twice_energy(const NodalForces& forces, const Response& response);
  double loss() const { return loss_; }  ///< J, that the material has taken up to the last accepted state
  void serialize(Archive& archive);
  /// States of forces of all nodes that have been loaded, at the last accepted state.
  void get(model::RelaxedState& state) const;
  void set(const model::RelaxedState& state);
  std::size_t n_recent() const { return recent_.size(); }  ///< nodes whose states go on step by step

 private:
  struct Recent {  // node that has been loaded since it went into the print
    body::CreepState force;
    Eigen::Vector3d lag, by_recent, by_print;  // N, m, m: remembered; D times the lags of both
    long loaded_at;                            // when n_accepted_ was this
  };
  struct Field {                           // D_j times the states of forces, of a node
    body::CreepState by_recent, by_print;  // the latter as gathered; empty: unknown
    long asked_at;
  };

  Field& field(int node, const Response& response);
  Lag remember_lags(const Response& response);
  body::CreepState displaced_by(int a, const std::vector<int>& nodes, const Response& response) const;
  double least_force() const;

  body::CreepLaws laws_;
  ContactPrint print_;
  std::map<int, Recent> recent_;  // by node
  std::vector<Field> fields_;     // of each node of the surface
  std::vector<int> known_;        // nodes whose field is known
  long n_accepted_ = 0;           // steps
  double loss_ = 0;
};

}  // namespace elastogear::dynamics
