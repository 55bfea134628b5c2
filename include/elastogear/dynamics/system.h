#pragma once
// A system of elastic bodies with joints, loads and contact pairs: F(U, V, A) = 0 and its derivatives.
// Vectors are ordered body by body, [s; q] each: joint coordinates, then elastic coordinates.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "elastogear/body/equations.h"
#include "elastogear/contact/pair.h"
#include "elastogear/dynamics/contact_loads.h"
#include "elastogear/dynamics/low_rank_solver.h"
#include "elastogear/model/result.h"

namespace elastogear::dynamics {

struct BodySetup {
  std::string name;
  std::shared_ptr<const model::ElasticBody> body = nullptr;
  body::Joint joint = {};
  double angle0 = 0;            ///< rad, revolute only
  double omega0 = 0;            ///< rad/s, revolute only
  double torque = 0;            ///< N m, constant, about the hinge axis, revolute only
  Eigen::VectorXd q_dot0 = {};  ///< n_q, initial elastic velocity; empty: zero
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

/// Everything that depends on the positions U alone.
struct ContactState {
  std::vector<contact::SurfaceState> surface;  ///< per body; x_B is right at the nodes that contact touches
  std::vector<PairContacts> pair;
  std::vector<NodalForces> force;  ///< per body
};

class System {
 public:
  struct Body {
    std::string name;
    body::Equations eq;
    Eigen::Index first;           ///< first entry of [s; q] in a system vector
    double torque;                ///< N m
    bool in_contact;              ///< named by a pair
    std::vector<int> node_group;  ///< face group of each surface node: that of its lowest face
  };

  /// Throws Error for what cannot be simulated: no bodies, equal names, values that are not finite, loads on
  /// fixed joints, pairs of a body with itself or without surfaces.
  System(std::vector<BodySetup> bodies, std::vector<PairSetup> pairs,
         body::InertiaLevel level = body::InertiaLevel::linear);

  Eigen::Index size() const { return U_0_.size(); }
  const std::vector<Body>& bodies() const { return bodies_; }
  const std::vector<PairSetup>& pairs() const { return pairs_; }
  const Eigen::VectorXd& initial_position() const { return U_0_; }
  const Eigen::VectorXd& initial_velocity() const { return V_0_; }
  std::vector<const body::Equations*> equations() const;

  body::Motion motion(std::size_t b, ConstVector U, ConstVector V, ConstVector A) const;
  contact::SurfaceMotion surface_motion(std::size_t b, ConstVector U) const;
  /// Placement and contacts in U; kept, so that a second call with an equal U costs nothing.
  const ContactState& contacts(ConstVector U);
  /// Largest penetration in U over the depth of its pair, beyond which it would no longer be seen; -.
  double depth_share(ConstVector U);
  Residual residual(ConstVector U, ConstVector V, ConstVector A);
  /// shift_v dF/dV + shift_a dF/dA + dF/dU
  EffectiveMatrix effective_matrix(ConstVector U, ConstVector V, ConstVector A, double shift_v,
                                   double shift_a);

 private:
  void add_body(const BodySetup& setup, body::InertiaLevel level);
  void add_pair(const PairSetup& setup);

  std::vector<Body> bodies_;
  std::vector<PairSetup> pairs_;
  std::vector<contact::Pair> detectors_;
  Eigen::VectorXd U_0_, V_0_;
  std::optional<Eigen::VectorXd> U_of_state_;
  ContactState state_;
};

/// Names of bodies, joints, pairs and face groups for the result file; the bodies' files stay empty.
model::ResultHeader result_header(const System& system);

}  // namespace elastogear::dynamics
