#pragma once
// Contact force of one slave node from its gap, its rate and its tangential motion (docs/theory, sections
// 6.6 and 6.7), with the derivatives that the consistent tangent takes.

#include <optional>

#include "contact/forces/friction.h"
#include "contact/projection/projection_kinematics.h"
#include "elastogear/contact/types.h"

namespace elastogear::contact {

/// A point without a penalty between bodies in motion: the force p of a step with 0 <= p, 0 <= g_t -
/// least_rate, one of them 0, for the rate g_t of the gap at its end (docs/theory, Eq. (6.32)). Which one
/// is not 0 is given. Between two steps the force is.
struct Impact {
  bool in_step = false;    ///< is the force of a step looked for?
  bool may_close = false;  ///< of an open gap: is it looked at?
  bool closed = false;     ///< is the rate held?
  double d = 0;            ///< N s/m, p = d (least_rate - g_t): Eq. (6.33)
  double p_held = 0;       ///< N, at least_rate, where nothing fades
  double stiffened = 1;    ///< -, d over c_p dt
  double alpha_f = 1;      ///< -, weight of the end of the step in the velocities given
  double dt = 0;           ///< s
  double rate = 0;         ///< m/s, at the start of the step
  double least_rate = 0;   ///< m/s
};

/// Constants of one slave node.
struct Law {
  double c_p = 0;           ///< N/m
  bool unilateral = false;  ///< the normal force is given: penetration is prevented elsewhere
  double compliance = 1;    ///< -, unilateral: what is left of that of the penalty
  double p_given = 0;       ///< N, unilateral: the normal force; augmented: that of a closed gap
  double stiffened = 1;     ///< -, augmented: factor of c_p, which forces that fade out do not depend on
  double d_p = 0;           ///< N s/m, while approaching
  double hysteresis = 0;    ///< s/m, Hunt and Crossley's factor, while approaching
  double offset = 0;        ///< m, added to the gap
  double mu = 0;            ///< coefficient of friction
  double mu_static = 0;     ///< of a node that sticks
  double v_0 = 0;           ///< m/s, of regularised friction; 0: sticks with c_t
  double c_t = 0;           ///< N/m, tangential stiffness of a node that sticks, beside the penalty c_p
  double mass = 0;          ///< kg, augmented: that an impulse at the node moves, or less
  double restitution = 0;   ///< -, rate of a gap after over that before an impact
  std::optional<Impact> impact = {};  ///< augmented, in motion
};

/// Force normal to the (smoothed) surface, N, with its derivatives.
struct NormalForce {
  double p = 0, p_g = 0, p_r = 0;  ///< N, N/m by the gap, N s/m by its rate
  double spring = 0;               ///< J, stored in the penalty alone
  double energy = 0;               ///< J, stored
  double energy_g = 0;             ///< N, its derivative by the gap
  double power = 0;                ///< W, dissipated
  double work = 0;                 ///< J, taken since the start of the step by an impact
  double excess_rate = 0;          ///< m/s, of an impact: of the gap at the end of the step, beyond the least
};
/// Can nothing come of a point with this gap? Points whose force is given may serve while they are open.
bool is_open(const Law& law, double gap);
/// Penalty and damping force while the gap closes, Eq. (6.15), that of an augmented Lagrangian, (6.31), and
/// that of an impact, (6.32).
NormalForce normal_force(const Law& law, double gap, double rate);

/// m/N, of a contact without penalty: what keeps its forces determinate where the bodies do not, and what
/// lets them fade out on an extension. Eq. (6.24).
double unilateral_compliance(const Law& law, double fade);

/// m/N, between a unilateral contact and the point it sticks to: beside that along n as c_p is beside c_t.
double tangential_compliance(const Law& law);

/// Friction of a point that stuck, or slid, after the last step.
struct Stuck {
  Friction friction;
  double mu = 0;                                ///< -, static or sliding
  double p = 0;                                 ///< N, the normal force
  bool slid = false;                            ///< after the last step
  Eigen::Vector3d z = Eigen::Vector3d::Zero();  ///< m, way since then with the stretch of then
};
/// By the tangential spring, stretched by z: Eq. (6.18).
Stuck stuck_on_spring(const Law& law, const Eigen::Vector3d& z, double p, bool slid);
/// The force along the master of a unilateral contact that sticks, Eq. (6.24a), but for how forces and way of
/// the local nodes follow from it.
TangentialForce tangential_force(const Law& law, const Stuck& stuck, const Eigen::Vector3d& n);
/// Sets the energy and the losses of the tangential spring (6.18), and the stretch that the next step starts
/// from.
void set_spring(const Law& law, const Stuck& stuck, ContactPoint& contact);

/// The gap to the smoothed surface and its gradient n (not of unit length) on the slave node. kColumns: as in
/// KinematicsBy.
template <int kColumns>
struct GapBy {
  double g = 0;       ///< m
  Eigen::Vector3d n;  ///< force direction
  Eigen::Matrix<double, 3, kColumns> n_x;
};

/// With the part of the force that is left on an extension.
struct Gap : GapBy<15> {
  LocalRow g_x;  ///< n' G
  FaceFunction fade{1};
  Eigen::Vector3d direction;  ///< of the force: n, or a blend of it with that of the faces beside
  Local3 direction_x;
};
/// Gap to the smooth surface and its gradient: Eq. (6.19).
Gap gap(const ProjectionKinematics& kinematics, const FaceFunction& height, double offset,
        const FaceFunction& fade = {1});
GapBy<3> gap(const KinematicsBy<3>& kinematics, const FaceFunction& height, double offset);

/// Tangential force that a unilateral contact is given.
struct GivenFriction {
  Eigen::Vector3d t = Eigen::Vector3d::Zero();  ///< N, on the slave node
  bool slides = false;                          ///< is it at the limit?
};

/// Tangential motion of the slave node on the master since it stuck, m.
struct StickMotion {
  Eigen::Vector3d u = Eigen::Vector3d::Zero();
  Local3 u_x = Local3::Zero();
  bool slides = false;
  GivenFriction given = {};  ///< unilateral only
};

/// Force, energy, power and tangent of a contact whose node velocities v and geometry are set. stick: none
/// for a node that was not in contact after the last step, or without stick. The slid part of stick's u and
/// the work it took go to the contact, too.
void apply_law(const Law& law, const ProjectionKinematics& kinematics, const Gap& gap,
               const StickMotion* stick, ContactPoint& contact);

}  // namespace elastogear::contact
