#pragma once
// Equations of motion of one elastic body in the floating frame of reference (docs/theory,
// Eqs. (3.6), (3.14) and (3.15)), in minimal coordinates: s of the joint, q of the basis. With the frame's
// acceleration a and angular acceleration alpha, the first moment S(q), inertia J(q) and coupling C_r(q),
//
//   H'[ m a + alpha x S + C_l'q'' + w x (w x S) + 2 w x S'                                     ]  = h_s
//     [ S x a + J alpha + C_r'q'' + w x J w + J' w + w x C_r'q'                                ]
//   C_l a + C_r alpha + M_r q'' + 2 (dC_r/dt) w - 1/2 w.(dJ/dq) w + D_r q' + K_r q                = h_q

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <memory>
#include <string>
#include <vector>

#include "elastogear/body/affine.h"
#include "elastogear/body/joint.h"
#include "elastogear/model/elastic_body.h"

namespace elastogear::body {

/// The part of the deformation that the inertia contains. constant: nothing. linear: S and J to first order
/// in q, C_r at q = 0. affine: all that its best affine field u ~ g + G X does, which contains `linear`.
/// full: everything; needs Inertia::S_2. But for `constant` the equations follow from one kinetic energy, so
/// that they conserve energy; but for `linear` it is positive in every deformed state.
enum class InertiaLevel { constant, linear, affine, full };
/// "constant", "linear", ...; in the order of InertiaLevel.
const std::vector<std::string>& inertia_level_names();

struct Equations {
  std::shared_ptr<const model::ElasticBody> body;
  Joint joint;
  MotionSubspace H;
  InertiaLevel level;
  AffinePart affine;                ///< level affine only, else empty
  Eigen::MatrixXd J_1;              ///< n_y x 6: dJ/dy at y = 0, xx yy zz xy yz xz; constant: n_y x 0
  Eigen::SparseMatrix<double> D_r;  ///< n_q x n_q, alpha M_r + beta K_r + diag(2 zeta omega)

  Eigen::Index n_s() const { return H.cols(); }
  Eigen::Index n_q() const { return body->n_q(); }
  /// Does inertia keep products of deformations?
  bool second_order() const { return level >= InertiaLevel::affine; }
  /// Inertia by the coordinates y in which deformation enters it: q, or those of the affine part.
  const model::Inertia& inertia() const {
    return level == InertiaLevel::affine ? affine.inertia : body->inertia;
  }
};

struct Motion {
  Eigen::VectorXd s, s_dot, s_ddot;  ///< n_s, see JointType
  Eigen::VectorXd q, q_dot, q_ddot;  ///< n_q
};

/// Generalised force; s is conjugate to the virtual twists H.
struct Force {
  Eigen::VectorXd s, q;
};

/// Throws Error for a joint without direction, and at level full when the body has no S_2.
Equations make_equations(std::shared_ptr<const model::ElasticBody> body, const Joint& joint,
                         InertiaLevel level);

FrameMotion frame_motion(const Equations& eq, const Motion& m);

Force inertia_force(const Equations& eq, const Motion& m);    ///< M(q) [s''; q'']
Force quadratic_force(const Equations& eq, const Motion& m);  ///< centrifugal and Coriolis, right-hand side
Force inner_force(const Equations& eq, const Motion& m);      ///< h_e = [0; D_r q' + K_r q]
/// Weight in the field g_W (m/s^2, world).
Force gravity_force(const Equations& eq, const Motion& m, const Eigen::Vector3d& g_W);

/// All that moves the inertia, each force as by the functions above.
struct MotionForces {
  Force inertia, quadratic, weight;
};
MotionForces motion_forces(const Equations& eq, const Motion& m, const Eigen::Vector3d& g_W);

/// Kinetic energy T from the velocity of a material point; the last equation is that of level affine: Eqs.
/// (3.2), (3.3) and (3.11d).
double kinetic_energy(const Equations& eq, const Motion& m);            ///< J
double elastic_energy(const Equations& eq, const Motion& m);            ///< J, 1/2 q.K_r q
double dissipation(const Equations& eq, const Eigen::VectorXd& q_dot);  ///< W, q'.D_r q'
/// J, -g.(m r + R S): of the weight.
double gravity_energy(const Equations& eq, const Motion& m, const Eigen::Vector3d& g_W);

/// Linear momentum (N s) and angular momentum about the world's origin (N m s), components in W.
struct Momentum {
  Eigen::Vector3d linear, angular;
};
Momentum momentum(const Equations& eq, const Motion& m);

}  // namespace elastogear::body
