#pragma once
// Equations of motion of a system of elastic bodies, F(t, U, V, A) = 0, and their derivatives.
// Vectors are ordered body by body, [s; q] each: joint coordinates without prescribed motion, then elastic
// coordinates.

#include <memory>
#include <vector>

#include "elastogear/base/archive.h"
#include "elastogear/dynamics/contact_loads.h"
#include "elastogear/dynamics/low_rank_solver.h"
#include "elastogear/dynamics/system_model.h"

namespace elastogear::contact {
class Pair;
}

namespace elastogear::dynamics {

class SystemContact;
enum class ForceAccuracy;
class SystemRelaxation;

/// F and, for each block (s then q of every body), the sum of the norms of the terms that it balances.
struct Residual {
  Eigen::VectorXd F;
  Eigen::VectorXd norm, scale;  ///< 2 n_bodies
};

/// The model, its evaluation at one state, and the history that the next evaluation starts from.
class System {
 public:
  using Body = SystemModel::Body;

  explicit System(SystemModel model);
  /// The system of make_system_model's arguments, with its errors.
  System(const std::vector<BodySetup>& bodies, const std::vector<PairSetup>& pairs,
         const Environment& environment = {}, const MarkerSetups& markers = {});
  /// The same, beginning with what another system of the same bodies and pairs has prepared for contact, and
  /// with its history of contact if it has been evaluated. Throws Error for one of other bodies or pairs.
  System(SystemModel model, const System& like);
  ~System();
  System(System&&) noexcept;

  const SystemModel& model() const { return model_; }
  Eigen::Index size() const { return model_.U_0.size(); }
  const std::vector<Body>& bodies() const { return model_.bodies; }
  const std::vector<PairSetup>& pairs() const { return model_.pairs; }
  const Environment& environment() const { return model_.environment; }
  const Eigen::VectorXd& initial_position() const { return model_.U_0; }
  const Eigen::VectorXd& initial_velocity() const { return model_.V_0; }
  const MarkerForces& marker_forces() const { return model_.marker_forces; }
  std::vector<SolverBody> solver_bodies() const;
  /// Returns whether LowRankSolver's inverse is exact.
  bool solver_is_exact() const;

  /// Motion of a body, prescribed coordinates included.
  body::Motion motion(std::size_t b, const State& x) const;
  std::vector<MovingBody> moving_bodies(const State& x) const;
  /// With the velocities that contact sees: those of the state, or prescribed ones.
  contact::SurfaceMotion surface_motion(std::size_t b, double time, ConstVector U, ConstVector V) const;
  /// Prescribes the rates of all joint coordinates (n_s each, by body; docs/theory, section 8.6) with
  /// which surfaces slide on each other, whatever V is, as of slow motion through equilibria; those of
  /// elastic coordinates are zero then. All other forces take V.
  void set_sliding(std::vector<Eigen::VectorXd> rates);
  /// Placement and contacts; kept, so that a second call with equal time, U and V costs nothing.
  const ContactState& contacts(double time, ConstVector U, ConstVector V);
  /// The same for states that are read and not solved for: forces without a penalty may be less exact, see
  /// ForceAccuracy.
  const ContactState& observed_contacts(const State& x);
  /// Largest penetration over the depth of its pair, beyond which it would no longer be seen; -.
  double depth_share(double time, ConstVector U, ConstVector V);
  /// Settings of a pair in force, with stiffness, depth and skin filled in.
  const contact::Settings& contact_settings(std::size_t pair) const;
  const contact::Pair& detector(std::size_t pair) const;
  /// Has a pair the augmented law?
  bool any_augmented() const;
  /// How far the gaps of the last evaluation are from closed, at most, over the depth of their pair; -.
  /// Augmented law; docs/theory, Eq. (6.31).
  double unclosed() const;
  /// Gives its contacts the forces found there, with which gaps close further in the next equilibrium.
  void augment();
  /// Multiplies the penalty stiffness by which gaps close.
  void stiffen(double factor);
  /// Gives the contacts these forces back.
  void set_forces(const std::vector<PairContacts>& pairs);
  /// From here on, until begin_equilibrium_search is called, states are those of a motion in which forces may
  /// be unbalanced by this share of them: those of contacts without a penalty need be no more exact. 0: they
  /// are as elsewhere.
  void set_force_tolerance(double unbalanced);
  /// From here on states are those of iterations towards a static equilibrium: forces of contacts without a
  /// penalty need be no more exact than this share of them. 0: they no longer are.
  void begin_equilibrium_search(double tolerance);
  /// Local minimum-gap points that stay where a former evaluation of this time found them need no longer
  /// stay. Returns whether there are any, so that forces may be others.
  bool release_points();
  /// Do materials relax with time, see Environment::moduli?
  bool relaxes_in_time() const;
  /// z of a viscoelastic body at the state, n_q x n_z; of elastic bodies without columns.
  Eigen::MatrixXd internal_variables(std::size_t b, const State& x) const;
  const body::RelaxationLaw& relaxation_law(std::size_t b) const;
  /// Begins and ends a step in which materials relax, and of the augmented law, of bodies in motion: begins
  /// the search for the forces of a step of dt (s), in which velocities are alpha_f times those at its end;
  /// looks, once F = 0 is solved, which contacts close and open (true: another set of them does); and ends
  /// it: the forces of the last evaluation, if they solved the step, are those of all states until the next
  /// one begins; of an impulse the share `delivered` changes the velocities at its end. dt = 0: at the start
  /// of a motion.
  void begin_step(double dt, double alpha_f);
  bool change_closed();
  void end_step(bool solved, double delivered);
  /// From here on states are those at rest at the end of a time dt (s) after the last accepted one, in which
  /// materials relax. Only where they do with time.
  void advance_relaxation(double dt);
  /// What a body remembers, with its deformation, of the last accepted state.
  model::RelaxedState relaxed_state(std::size_t b) const;
  /// Was there an impulse in the last step, or the one before it? It lasts for a step only.
  bool had_impulse() const;
  bool had_impulse_before() const;
  /// To be called once for the initial state and after every accepted step: what sticks now does so from
  /// here, and the energy that contact has taken is added up. Where the state is not observed, new
  /// contacts since the last stage may be missed, which the next stage finds.
  void accept(const State& x, bool is_observed = true);
  /// J, taken by damping and friction of contact up to the last accepted state.
  double contact_loss() const;
  /// J, stored in the residual flexibility of a body by the contact forces of the last evaluation.
  double residual_energy(std::size_t b);
  /// J, that has been taken by the creep of its residual displacement up to the last accepted state.
  double residual_loss(std::size_t b) const;
  Residual residual(const State& x);
  /// shift.v dF/dV + shift.a dF/dA + dF/dU
  EffectiveMatrix effective_matrix(const State& x, const body::Shifts& shift);
  /// Load, friction and, where the motion is prescribed, the force that it takes: n_s, N or N m.
  Eigen::VectorXd joint_force(std::size_t b, const State& x);
  /// Turns what the second end of a bushing is unloaded at, by this angle (rad) about z of the axes.
  void turn_bushing(std::size_t i, double angle);
  /// Makes the present orientations those from which local rotation vectors count, and sets these to zero in
  /// U. True when a joint has one.
  bool rebase(Eigen::Ref<Eigen::VectorXd> U);
  /// All that later evaluations take from earlier ones: re-based orientations, contact history, internal
  /// variables of materials.
  void serialize(Archive& archive);

 private:
  const ContactState& contacts(double time, ConstVector U, ConstVector V, ForceAccuracy accuracy);
  /// Motion of a body as contact sees it.
  body::Motion sliding_motion(std::size_t b, const State& x) const;
  /// Generalised forces of all loads and bushings, one entry per body.
  std::vector<MarkerForce> at_markers(const State& x) const;
  /// D_r q' + K_r q less what materials have relaxed.
  body::Force inner_force(std::size_t b, double time, const body::Motion& m) const;
  /// Sum and norms of a body's terms: [F_s (n_s); F_q].
  body::Force balance(std::size_t b, const State& x, const MarkerForce& marker_force, Residual* r);

  SystemModel model_;
  std::vector<Eigen::VectorXd> sliding_ = {};  // rates of joint coordinates, by body; empty: those of V
  std::unique_ptr<SystemContact> contact_;
  std::unique_ptr<SystemRelaxation> relaxation_;
};

}  // namespace elastogear::dynamics
