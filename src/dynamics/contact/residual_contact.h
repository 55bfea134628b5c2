#pragma once
// Contact of bodies with residual flexibility: contact forces f and the static responses w = R f to them
// depend on each other, f = f(x + R f). Newton's method solves for both at every evaluation, so that f stays
// a function of the coordinates (docs/theory, section 6.9).

#include <functional>
#include <optional>
#include <vector>

#include "dynamics/contact/residual_flexibility.h"
#include "elastogear/base/archive.h"
#include "elastogear/dynamics/system_model.h"

namespace elastogear::dynamics {

/// How exact forces without a penalty are: as all forces in balance are, for states that are solved for; or
/// as results are read, for others, which takes fewer contact detections.
enum class ForceAccuracy { balanced, observed };

class ResidualContact {
 public:
  /// Bodies without static responses have no residual displacement. The bodies of the model must outlive
  /// this.
  explicit ResidualContact(const SystemModel& model);

  bool any() const;
  bool has_flexibility(std::size_t b) const { return flexibility_[b].has_value(); }
  /// Residual displacement for contact::Pair::detect; to be called once for each pair of the body between two
  /// calls of seen().
  contact::ResidualDisplacement residual(std::size_t b);
  void seen();
  Eigen::Vector3d displacement(std::size_t b, int node) {
    return flexibility_[b]->displacement(node);
  }  ///< m, BRF
  /// m, BRF: what is left of former forces; zero for an elastic body.
  Eigen::Vector3d lag(std::size_t b, int node) { return flexibility_[b]->lag(node); }
  /// Puts the static response of a body to these forces in place.
  void respond(std::size_t b, const NodalForces& forces) {
    if (has_flexibility(b)) respond_to(b, forces);
  }
  /// R among the nodes (model::Surface numbers), m/N; empty for a
  /// body without residual flexibility.
  const Eigen::MatrixXd& among(std::size_t b, const std::vector<int>& node);

  /// N, norm of the change of all forces with a penalty that the roundoff of positions makes.
  void expect_roundoff(double force) { roundoff_ = force; }
  /// Solves for contact forces and static responses by Newton's method, Eq. (6.21); a step that makes the
  /// force residual larger is halved. The state holds the contacts found with the present static responses,
  /// which `detect` finds anew. Sets state.balanced.
  void solve(ContactState& state, const std::function<void()>& detect);
  /// The same for pairs without a penalty: solves for the forces that close the gaps, Eq. (6.24), at closest
  /// points that each trial finds anew. Contacts that stay open are taken out of the state.
  void solve_unilateral(ContactState& state, ForceAccuracy accuracy, const std::function<void()>& detect);
  /// Puts the static responses in place to forces extrapolated from the last two accepted states to this
  /// time.
  void predict(double time);
  /// Keeps the present forces as those of an accepted step at this time.
  void accept(double time);
  /// Tolerance of forces in what follows, where it is above that which they have without.
  void ask_forces(double tolerance) { asked_ = tolerance; }
  /// See System::begin_equilibrium_search. Returns whether forces must be more exact than before.
  bool begin_equilibrium_search(double tolerance);
  /// Does the residual displacement of a body creep, whatever the moduli are?
  bool creeps(std::size_t b) const { return has_flexibility(b) && flexibility_[b]->is_viscoelastic(); }
  /// From here on its states are at this point of a step.
  void set_point(std::size_t b, body::Moduli moduli, const body::StepPoint& at);

  /// Of the last accepted state.
  void get_creep(std::size_t b, model::RelaxedState& state) const {
    if (has_flexibility(b)) flexibility_[b]->get_history(state);
  }
  void set_creep(std::size_t b, const model::RelaxedState& state) {
    if (has_flexibility(b)) flexibility_[b]->set_history(state);
  }

  double energy(std::size_t b);      ///< J, f'R f / 2 of an elastic body
  double loss(std::size_t b) const;  ///< J, taken by creep up to the last accepted state
  /// J, work of forces on the contact nodes through the change of the static responses since the last
  /// accepted state: the mean of the forces then and now, of each body, times that change.
  double work(const std::vector<NodalForces>& then, const std::vector<NodalForces>& now);
  /// Stores or restores the forces that the next solution starts from.
  void serialize(Archive& archive);

 private:
  // Difference between the contact forces found and the forces whose static response was in place.
  struct ForceResidual {
    double absolute = 0;  // N
    double relative = 0;  // of the forces found, at most 1
  };
  ForceResidual force_residual(const std::vector<NodalForces>& found) const;
  // Newton step: puts the static responses in place to the forces that, to first order, contact will find.
  Eigen::VectorXd newton_step(const ContactState& state);
  // Goes half of the way back to the static responses before the last Newton step.
  void backtrack();
  // Newton step that changes the contacts to first order instead of detecting them again, for a force
  // residual whose square is negligible. Returns false and does nothing where forces have no potential.
  bool linear_step(ContactState& state);
  // Puts the forces whose static responses are in place in the place of those found.
  void take_forces_of_response(ContactState& state) const;
  // m, BRF, of each body: 3 n, of the nodes of the state's forces, with the responses in place.
  std::vector<Eigen::VectorXd> displacements(const ContactState& state);
  // w: m, 3 n, displacements of the nodes that contacts were found with.
  Eigen::VectorXd missing_response(std::size_t b, const NodalForces& found, const Eigen::MatrixXd& R,
                                   const Eigen::VectorXd& w);
  void respond_to(std::size_t b, const NodalForces& forces);
  struct Change {
    double forces = 0;         // as part of them
    bool slides_anew = false;  // does a node slide that stuck before, or stick that slid?
    bool bends = true;         // is what is left of second order?
  };
  // Closes the gaps at unchanged closest points: sets the forces of the contacts and the static responses,
  // these by the given share of their change. Returns nothing where there is no solution.
  std::optional<Change> close_gaps(ContactState& state, double share);
  double least_force(const ContactState& state) const;

  struct Accepted {
    double time = 0;
    std::vector<NodalForces> forces = {};  // of each body; of none before the first
  };

  std::vector<std::optional<ResidualFlexibility>> flexibility_;  // of each body
  Accepted last_, before_;
  double roundoff_ = 0;            // N, see expect_roundoff
  double expected_ = 0;            // expected change of the forces found last, as part of them
  double asked_ = 0;               // tolerance of forces that Newton's method of the system needs
  double sought_ = 0;              // tolerance of forces in iterations towards rest; 0: there are none
  double allowed_ = 0;             // tolerance of the forces that are being found
  std::vector<NodalForces> left_;  // of each body, the forces before the last Newton step
  std::vector<double> change_;     // m, not yet seen by all pairs
};

}  // namespace elastogear::dynamics
