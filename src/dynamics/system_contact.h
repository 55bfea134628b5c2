#pragma once
// Contact of all pairs of a system: its evaluation at one state, and what the next one takes from the steps
// before.

#include <optional>
#include <vector>

#include "dynamics/contact/residual_contact.h"
#include "dynamics/stations/station_contact.h"
#include "elastogear/contact/pair.h"
#include "elastogear/dynamics/system_model.h"

namespace elastogear::dynamics {

class SystemContact {
 public:
  /// The elastic bodies of the model must outlive this. like: of the same bodies and pairs, whose detectors
  /// are copied; null: they are made anew.
  explicit SystemContact(const SystemModel& model, const SystemContact* like = nullptr);

  /// What was evaluated last, if that was this state with forces as exact; null otherwise.
  const ContactState* known(double time, ConstVector U, ConstVector V, ForceAccuracy accuracy) const;
  /// Contacts and static responses of a state with these motions of the bodies' surfaces.
  const ContactState& evaluate(double time, ConstVector U, ConstVector V,
                               const std::vector<contact::SurfaceMotion>& motion, ForceAccuracy accuracy);
  /// Makes known() forget the last evaluation.
  void forget() { U_.reset(); }

  const contact::Settings& settings(std::size_t pair) const { return detectors_[pair].settings(); }
  const contact::Pair& detector(std::size_t pair) const { return detectors_[pair]; }
  /// The following are those of the last evaluation. System has their docstrings.
  double depth_share() const;
  double residual_energy(std::size_t b) { return residual_contact_.energy(b); }
  double residual_loss(std::size_t b) const { return residual_contact_.loss(b); }
  /// Does the residual displacement of a body creep? It is then evaluated at this point of a step.
  bool creeps(std::size_t b) const { return residual_contact_.creeps(b); }
  void set_point(std::size_t b, body::Moduli moduli, const body::StepPoint& at) {
    residual_contact_.set_point(b, moduli, at);
  }
  /// Adds what the residual displacement of a body remembers.
  void get_creep(std::size_t b, model::RelaxedState& state) const { residual_contact_.get_creep(b, state); }
  Eigen::MatrixXd flexibility_among(std::size_t b, const std::vector<int>& node) {
    return stations_ ? Eigen::MatrixXd() : residual_contact_.among(b, node);  // theirs is in their stiffness
  }

  /// Pairs with the augmented law; System has the docstring of the others.
  bool any_augmented() const;
  double unclosed() const;
  void augment();
  void stiffen(double factor);
  void set_forces(const std::vector<PairContacts>& pairs);
  void begin_step(double dt, double alpha_f);
  bool change_closed();
  void end_step(bool solved, double delivered);
  bool had_impulse() const { return history_.impulse; }
  bool had_impulse_before() const { return history_.impulse_before; }

  void set_force_tolerance(double unbalanced) { residual_contact_.ask_forces(unbalanced); }
  void begin_equilibrium_search(double tolerance);
  bool release_points();
  /// Whether evaluations from now on follow the contacts of the last one wherever bodies go, and miss new
  /// ones.
  void follow_contacts(bool follow) { follows_ = follow; }
  /// Accepts the last evaluation as the end of a step.
  void accept();
  /// J, taken by damping and friction up to the last accepted state.
  double loss() const { return history_.loss; }
  /// The history of contact, and all else that later evaluations take from earlier ones.
  void serialize(Archive& archive);

 private:
  struct History {
    bool accepted = false;                         // is there an accepted state?
    double time = 0;                               // s, of the last one
    double power = 0;                              // W, taken by damping and regularised friction then
    double loss = 0;                               // J, taken since the start
    bool impulse = false, impulse_before = false;  // in the last step, in the one before
    std::vector<NodalForces> friction = {};        // of each body, regularised, of the last one
  };

  void make_detector(const SystemModel& model, const PairSetup& pair);
  void copy_detectors(const SystemContact& like);
  bool is_augmented(std::size_t p) const { return pairs_[p].settings.law == contact::ContactLaw::augmented; }
  bool is_unilateral() const;
  void place(const std::vector<contact::SurfaceMotion>& motion);
  void place_touched(std::size_t p);
  void detect(const std::vector<contact::SurfaceMotion>& motion);
  bool has_friction(std::size_t p, contact::FrictionLaw law) const;
  double friction_loss_of_responses();
  bool remembers_forces() const;
  void solve(const std::vector<contact::SurfaceMotion>& motion);

  std::vector<PairSetup> pairs_;
  std::vector<const model::Surface*> surface_;  // of each body; null where no pair names it
  std::vector<contact::Pair> detectors_;        // they keep the nodes that stick
  std::optional<StationContact> stations_;      // in place of detectors, if all pairs touch there
  bool unilateral_ = false;  // do the pairs of bodies with residual flexibility have no penalty?
  ResidualContact residual_contact_;
  History history_;
  double time_ = 0;       // s, of the last evaluation
  bool follows_ = false;  // are contacts of the last look at all followed, as far as they are found?
  ForceAccuracy accuracy_ = ForceAccuracy::balanced;
  std::optional<Eigen::VectorXd> U_;
  Eigen::VectorXd V_;
  ContactState state_;
};

}  // namespace elastogear::dynamics
