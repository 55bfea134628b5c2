#pragma once
// A system of elastic bodies with joints, loads and contact pairs: F(t, U, V, A) = 0 and its derivatives.
// Vectors are ordered body by body, [s; q] each: joint coordinates without prescribed motion, then elastic
// coordinates.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "elastogear/body/equations.h"
#include "elastogear/contact/pair.h"
#include "elastogear/dynamics/axis.h"
#include "elastogear/dynamics/contact_loads.h"
#include "elastogear/dynamics/low_rank_solver.h"
#include "elastogear/dynamics/marker_forces.h"
#include "elastogear/dynamics/residual_contact.h"
#include "elastogear/model/result.h"

namespace elastogear::dynamics {

struct BodySetup {
  std::string name;
  std::shared_ptr<const model::ElasticBody> body = nullptr;
  body::Joint joint = {};
  Axis rotation = {};                                   ///< revolute and cylindrical: about the axis
  Axis translation = {};                                ///< prismatic and cylindrical: along the axis
  Eigen::Vector3d velocity0 = Eigen::Vector3d::Zero();  ///< free: m/s, of the BRF's origin, in W
  Eigen::Vector3d omega0 = Eigen::Vector3d::Zero();     ///< free and spherical: rad/s, in the BRF
  Eigen::VectorXd q_dot0 = {};                          ///< n_q, initial elastic velocity; empty: zero
};

struct PairSetup {
  std::string name;      ///< "a:b", surface a and surface b of the contact module
  int body[2] = {0, 1};  ///< indices into the bodies
  contact::Settings settings;
};

using ConstVector = Eigen::Ref<const Eigen::VectorXd>;

/// F and, for each block (s then q of every body), the sum of the norms of the terms that it balances.
struct Residual {
  Eigen::VectorXd F;
  Eigen::VectorXd norm, scale;  ///< 2 n_bodies
};

/// Everything that depends on time, positions U and velocities V alone.
struct ContactState {
  std::vector<contact::SurfaceState> surface;  ///< per body; x_B is right at the nodes that contact touches
  std::vector<PairContacts> pair;
  std::vector<NodalForces> force;  ///< per body
  bool balanced = true;            ///< did Newton's method for contact forces and static responses converge?
};

/// History of contact from step to step, which a run that goes on from a stored state needs.
struct ContactHistory {
  double time = 0;                                      ///< s, of the last accepted state
  double power = 0;                                     ///< W, taken by damping and regularised friction then
  double loss = 0;                                      ///< J, taken since the start
  std::vector<std::vector<contact::StickPoint>> stuck;  ///< per pair
};

/// A state of the system. The vectors must outlive it.
struct State {
  double time;  ///< s
  ConstVector U, V, A;
};

/// Settings and loads common to all bodies.
struct Environment {
  body::InertiaLevel inertia = body::InertiaLevel::affine;
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< m/s^2, in W
  double gravity_rise = 0;  ///< s, from time 0 on, within which gravity grows from zero
};
double gravity_share(const Environment& environment, double time);  ///< 0..1, of its gravity
Eigen::Vector3d gravity(const Environment& environment, double time);

class System {
 public:
  struct Body {
    std::string name;
    body::Equations eq;
    Eigen::Index first;              ///< first entry of [s; q] in a system vector
    std::vector<Axis> axis;          ///< one per joint coordinate; free, spherical: none
    std::vector<Eigen::Index> open;  ///< joint coordinates without prescribed motion, ascending
    bool in_contact;                 ///< named by a pair
    std::vector<int> node_group;     ///< face group of each surface node: that of its lowest face
    Eigen::VectorXd node_area;       ///< m^2, share of the surface of each of its nodes

    Eigen::Index n_open() const { return static_cast<Eigen::Index>(open.size()); }
  };

  /// Throws Error for what cannot be simulated: no bodies, equal names, values that are not finite, motion or
  /// loads that the joint does not have, bodies without mass that may move, pairs of a body with itself or
  /// without surfaces.
  System(std::vector<BodySetup> bodies, std::vector<PairSetup> pairs, const Environment& environment = {},
         const MarkerSetups& markers = {});

  Eigen::Index size() const { return U_0_.size(); }
  const std::vector<Body>& bodies() const { return bodies_; }
  const std::vector<PairSetup>& pairs() const { return pairs_; }
  const Environment& environment() const { return environment_; }
  const Eigen::VectorXd& initial_position() const { return U_0_; }
  const Eigen::VectorXd& initial_velocity() const { return V_0_; }
  const MarkerForces& marker_forces() const { return marker_forces_; }
  std::vector<SolverBody> solver_bodies() const;
  /// Returns whether LowRankSolver's inverse is exact.
  bool solver_is_exact() const;

  /// Motion of a body, prescribed coordinates included.
  body::Motion motion(std::size_t b, const State& x) const;
  std::vector<MovingBody> moving_bodies(const State& x) const;
  contact::SurfaceMotion surface_motion(std::size_t b, double time, ConstVector U, ConstVector V) const;
  /// Placement and contacts; kept, so that a second call with equal time, U and V costs nothing.
  const ContactState& contacts(double time, ConstVector U, ConstVector V);
  /// Largest penetration over the depth of its pair, beyond which it would no longer be seen; -.
  double depth_share(double time, ConstVector U, ConstVector V);
  /// Settings of a pair in force, with stiffness, depth and skin filled in.
  const contact::Settings& contact_settings(std::size_t pair) const { return detectors_[pair].settings(); }
  /// To be called once for the initial state and after every accepted step: what sticks now does so from
  /// here, and the energy that contact has taken is added up.
  void accept(const State& x);
  ContactHistory contact_history() const;
  /// Throws Error for another number of pairs, or nodes and faces that they do not have.
  void restore(const ContactHistory& history);
  /// J, taken by damping and friction of contact up to the last accepted state.
  double contact_loss() const { return history_.loss; }
  /// J, stored in the residual flexibility of a body by the contact forces of the last evaluation.
  double residual_energy(std::size_t b) { return residual_contact_.energy(b); }
  Residual residual(const State& x);
  /// shift.v dF/dV + shift.a dF/dA + dF/dU
  EffectiveMatrix effective_matrix(const State& x, const body::Shifts& shift);
  /// Load, friction and, where the motion is prescribed, the force that it takes: n_s, N or N m.
  Eigen::VectorXd joint_force(std::size_t b, const State& x);
  /// Makes the present orientations those from which local rotation vectors count, and sets these to zero in
  /// U. True when a joint has one.
  bool rebase(Eigen::Ref<Eigen::VectorXd> U);
  /// All that later evaluations take from earlier ones: re-based orientations, contact history.
  void serialize(Archive& archive);

 private:
  void add_body(const BodySetup& setup);
  void add_pair(const PairSetup& setup);
  void serialize_contact_history(Archive& archive);
  void detect(const std::vector<contact::SurfaceMotion>& motion);
  ResidualContact::ForceResidual force_residual_now(const std::vector<contact::SurfaceMotion>& motion);
  void find_static_responses(const std::vector<contact::SurfaceMotion>& motion);
  void place_touched(std::size_t p);
  void add_marker_forces(const MarkerSetups& setups);
  /// Generalised forces of all loads and bushings, one entry per body.
  std::vector<MarkerForce> at_markers(const State& x) const;
  /// Sum and norms of a body's terms: [F_s (n_s); F_q].
  body::Force balance(std::size_t b, const State& x, const MarkerForce& marker_force, Residual* r);

  std::vector<Body> bodies_;
  std::vector<PairSetup> pairs_;
  Environment environment_;
  std::vector<contact::Pair> detectors_;
  MarkerForces marker_forces_;
  ResidualContact residual_contact_{{}};
  Eigen::VectorXd U_0_, V_0_;
  std::optional<Eigen::VectorXd> U_of_state_;
  Eigen::VectorXd V_of_state_;
  double time_of_state_ = 0;
  ContactHistory history_;  // stuck: kept by the detectors
  bool accepted_ = false;   // is there an accepted state?
  ContactState state_;
};

/// Names of bodies, joints, pairs and face groups for the result file; the bodies' files stay empty.
model::ResultHeader result_header(const System& system);

}  // namespace elastogear::dynamics
