#include "contact/forces/law.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "contact/forces/surface_boundary.h"
#include "elastogear/base/rotation.h"

namespace elastogear::contact {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kLeastFade = 1e-6;  // of a unilateral force on an extension, whose compliance must be finite

// A vector with its derivatives by the local positions and velocities.
struct Varying {
  Vector3d value = Vector3d::Zero();
  Local3 x = Local3::Zero(), v = Local3::Zero();
};

Local flat(const LocalVectors& v) { return v.reshaped(); }  // of a slave point and its master's nodes

// Velocity of the slave node against the master, v_r of docs/theory, Eq. (6.13), and its derivatives.
Varying relative_velocity(const ProjectionKinematics& kinematics, const LocalVectors& v) {
  Varying rate;
  rate.value = kinematics.G * flat(v);
  rate.v = kinematics.G;
  rate.x = -skew(kinematics.spin * flat(v)) * kinematics.d_x;
  for (int i = 0; i < kinematics.n_dir; ++i)
    rate.x -= (v.rightCols<4>() * kinematics.N_a.col(i)) * kinematics.D.row(i);
  return rate;
}

// The part of y normal to the direction of the gap.
Vector3d tangential(const Vector3d& y, const Gap& gap) {
  const Vector3d n = gap.n / gap.n.norm();
  return (Matrix3d::Identity() - n * n.transpose()) * y;
}

// The same with its derivatives.
Varying tangential(const Varying& y, const Gap& gap) {
  const double length = gap.n.norm();
  const Vector3d n = gap.n / length;
  const Matrix3d T = Matrix3d::Identity() - n * n.transpose();
  const Local3 n_x = T * gap.n_x / length;
  return {T * y.value, T * y.x - n * (y.value.transpose() * n_x) - n.dot(y.value) * n_x, T * y.v};
}

// The given force p of a unilateral contact, with p + k (g + c p) in the place of a penalty: Eq. (6.24).
NormalForce given_force(const Law& law, double fade) {
  const double c = unilateral_compliance(law, fade), p = law.p_given;
  NormalForce f;
  f.p = p;
  f.p_g = -1 / c;
  f.energy = 0.5 * c * p * p;
  return f;
}

NormalForce impact_force(const Impact& impact, double p_given, double rate) {
  NormalForce f;
  if (!impact.in_step) {
    f.p = p_given;
    f.work = -0.5 * p_given * impact.dt * (impact.rate + rate);
    return f;
  }
  const double end_rate = (rate - (1 - impact.alpha_f) * impact.rate) / impact.alpha_f;
  f.excess_rate = end_rate - impact.least_rate;
  if (!impact.closed) return f;
  f.p = impact.p_held - impact.d * f.excess_rate;
  f.p_r = -impact.d / impact.alpha_f;
  return f;
}

// The parts that make up a contact force.
struct Parts {
  Vector3d slip;       // velocity
  Varying motion;      // argument of friction: velocity, or displacement of a node that sticks
  NormalForce normal;  // of the whole node
  double p = 0;        // N, what is left of it on an extension
  LocalRow p_x, p_v;   // its derivatives
  Friction friction;
  double mu = 0;
};

// The force normal to the surface, with its derivatives.
void set_normal(const Law& law, const ProjectionKinematics& kinematics, const Gap& gap,
                const ContactPoint& contact, Parts& parts) {
  if (law.unilateral) {
    parts.normal = given_force(law, gap.fade.f);
    parts.p = law.p_given;
    // g + c p = 0 with c = (1 / fade + ...) / c_p
    const double fade = std::max(gap.fade.f, kLeastFade), c_f = -1 / (law.c_p * fade * fade);
    parts.p_x = parts.normal.p_g * (gap.g_x + parts.p * c_f * gap.fade.f_a.transpose() * kinematics.D);
    parts.p_v.setZero();
    return;
  }
  const Varying rate = relative_velocity(kinematics, contact.v);
  parts.normal = normal_force(law, gap.g, gap.n.dot(rate.value));
  parts.p = gap.fade.f * parts.normal.p;
  const LocalRow rate_x = rate.value.transpose() * gap.n_x + gap.n.transpose() * rate.x;
  parts.p_x = gap.fade.f * (parts.normal.p_g * gap.g_x + parts.normal.p_r * rate_x) +
              parts.normal.p * gap.fade.f_a.transpose() * kinematics.D;
  parts.p_v = gap.fade.f * parts.normal.p_r * gap.g_x;
}

Parts parts(const Law& law, const ProjectionKinematics& kinematics, const Gap& gap, const StickMotion* stick,
            const ContactPoint& contact) {
  Parts parts;
  parts.slip = tangential(Vector3d(kinematics.G * flat(contact.v)), gap);
  set_normal(law, kinematics, gap, contact, parts);
  if (law.mu == 0) return parts;
  if (law.v_0 > 0) {
    parts.mu = law.mu;
    parts.motion = tangential(relative_velocity(kinematics, contact.v), gap);
    parts.friction = regularised(parts.motion.value, law.v_0, law.mu * parts.p);
  } else if (stick && law.unilateral) {
    const GivenFriction& given = stick->given;
    const double c = tangential_compliance(law);
    parts.mu = stick->slides || given.slides ? law.mu : law.mu_static;
    const bool slides = given.slides && parts.p > 0;
    const Vector3d n = gap.n.normalized(), t = given.t - n * n.dot(given.t);
    parts.motion = tangential({slides ? stick->u : -c * t, stick->u_x, Local3::Zero()}, gap);
    parts.friction = given_friction(t, parts.motion.value, c, parts.mu * parts.p, slides);
  } else if (stick) {
    parts.motion = tangential({stick->u, stick->u_x, Local3::Zero()}, gap);
    const Stuck stuck = stuck_on_spring(law, parts.motion.value, parts.p, stick->slides);
    parts.mu = stuck.mu;
    parts.friction = stuck.friction;
  }
  return parts;
}

// df = f_x dx + f_v dv
Varying force(const Gap& gap, const Parts& parts) {
  const Friction& friction = parts.friction;
  const Vector3d per_p = gap.direction - (friction.at_limit ? parts.mu : 0.0) * friction.direction;
  Varying f;
  f.value = parts.p * (gap.direction - parts.mu * friction.direction);
  f.x = per_p * parts.p_x + parts.p * gap.direction_x;
  f.v = per_p * parts.p_v;
  if (friction.K.isZero(0)) return f;
  f.x -= friction.K * parts.motion.x;
  f.v -= friction.K * parts.motion.v;
  return f;
}

// Directions that the couple f x d can have: on faces d is normal.
Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> couple_directions(const ProjectionKinematics& kinematics) {
  if (kinematics.n_dir < 2) return Matrix3d::Identity();
  Eigen::Matrix<double, 3, 2> tangents;
  tangents.col(0) = kinematics.n.unitOrthogonal();
  tangents.col(1) = kinematics.n.cross(tangents.col(0));
  return tangents;
}

// Columns b with df = b (b^-1 df): the first one, along which f changes with p, has all that changes p.
Matrix3d force_directions(const Gap& gap, const Parts& parts) {
  Matrix3d b;
  const Vector3d n = gap.direction.normalized(), slip = parts.friction.direction;
  b.col(0) = gap.direction - (parts.friction.at_limit ? parts.mu : 0.0) * slip;
  b.col(1) = slip.isZero(0) ? n.unitOrthogonal() : Vector3d(slip - n * n.dot(slip)).normalized();
  b.col(2) = n.cross(b.col(1));
  return b;
}

// F = B' f + spin' (f x d) = G' f, W = [G' b, P_alpha, spin' T]: dF = G' b (b^-1 df) + P_alpha dxi_alpha +
// spin' T T' (f x dd). The change of the spin is left out. docs/theory, Eq. (6.14).
void set_tangent(const ProjectionKinematics& kinematics, const Varying& f, const Matrix3d& b,
                 ContactPoint& contact) {
  const auto T = couple_directions(kinematics);
  const Eigen::Index m = T.cols(), n = 3 + kinematics.n_dir + m;
  const Matrix3d b_inverse = b.inverse();
  contact.W.setZero(15, n);
  contact.V.setZero(15, n);
  contact.V_dot.setZero(15, n);
  contact.k.setIdentity(n, n);
  contact.W.leftCols<3>() = kinematics.G.transpose() * b;
  contact.V.leftCols<3>() = -(b_inverse * f.x).transpose();
  for (int i = 0; i < kinematics.n_dir; ++i) {
    contact.W.col(3 + i) = -spread(0, kinematics.N_a.col(i)).transpose() * f.value;
    contact.V.col(3 + i) = -kinematics.D.row(i).transpose();
  }
  contact.W.rightCols(m) = kinematics.spin.transpose() * T;
  contact.V.rightCols(m) = -(skew(f.value) * kinematics.d_x).transpose() * T;
  if (!f.v.isZero(0)) contact.V_dot.leftCols<3>() = -(b_inverse * f.v).transpose();
}

// Sets the compliance c and the gradients F_p, g_x of a contact without penalty: docs/theory, Eq. (6.24).
void set_unilateral(const Law& law, const ProjectionKinematics& kinematics, const Gap& gap,
                    const Parts& parts, ContactPoint& contact) {
  const bool follows_p = law.v_0 > 0;  // what sticks has a tangential force of its own
  const Vector3d per_p = gap.direction - (follows_p ? parts.mu : 0.0) * parts.friction.direction;
  contact.c = unilateral_compliance(law, gap.fade.f);
  const LocalRow g_x = -contact.c * parts.p_x, faded = g_x - gap.g_x;
  contact.F_p = (kinematics.G.transpose() * per_p + faded.transpose()).reshaped(3, 5);
  contact.g_x = g_x.reshaped(3, 5);
}

// The energy e of which -e d(fade) is the force on an extension. That of a unilateral contact, c p^2 / 2 at
// g + c p = 0, and of an impact, has -c'(fade) p^2 / 2 in its place.
FadingEnergy fading_energy(const Law& law, const ProjectionKinematics& kinematics, const Gap& gap,
                           const Parts& parts) {
  if (!law.unilateral && !law.impact)
    return {parts.normal.spring, parts.normal.energy_g * gap.g_x, LocalRow::Zero()};
  const double fade = std::max(gap.fade.f, kLeastFade), weight = 1 / (law.c_p * fade * fade),
               e = 0.5 * weight * parts.p * parts.p;
  return {e, weight * parts.p * parts.p_x - 2 * e / fade * gap.fade.f_a.transpose() * kinematics.D,
          weight * parts.p * parts.p_v};
}

// w / (w + s (1 - w)) of the share w that is left over a free boundary: with it the stiffness s c_p closes
// gaps up to the compliance (1 / w - 1) / c_p, as d of an impact does where s = d / (c_p dt).
FaceFunction fade_of(const Law& law, const FaceFunction& w) {
  if (law.impact && !law.impact->in_step) return {1};  // the whole force is given
  const double s = law.impact ? law.impact->stiffened : law.stiffened, sum = w.f + s * (1 - w.f);
  if (s == 1 || w.f == 1) return w;
  const double slope = s / (sum * sum), bend = -2 * s * (1 - s) / (sum * sum * sum);
  return {w.f / sum, slope * w.f_a, slope * w.f_ab + bend * w.f_a * w.f_a.transpose()};
}

// Gap to the smooth surface; its gradient changes by dn = -d(a y) with y = A^-1 h_a.
template <int kColumns>
GapBy<kColumns> smooth_gap(const KinematicsBy<kColumns>& kinematics, const FaceFunction& height,
                           double offset) {
  GapBy<kColumns> result{kinematics.g - height.f + offset, kinematics.n, kinematics.n_x};
  if (kinematics.n_dir == 0 || height.f_a.isZero(0)) return result;
  const Eigen::Matrix2d A_inverse = kinematics.A.inverse();
  const Eigen::Vector2d y = A_inverse * height.f_a;
  result.n -= kinematics.a * y;
  result.n_x -= kinematics.a * (A_inverse * (height.f_ab * kinematics.D - metric_derivative(kinematics, y)));
  for (int i = 0; i < kinematics.n_dir; ++i) result.n_x -= tangent_derivative(kinematics, i) * y[i];
  return result;
}

}  // namespace

bool is_open(const Law& law, double gap) {
  if (law.unilateral) return false;
  if (law.impact) return law.impact->in_step && !law.impact->may_close;
  return !(law.c_p * gap < law.p_given);
}

NormalForce normal_force(const Law& law, double gap, double rate) {
  if (is_open(law, gap)) return {};
  if (law.impact) return impact_force(*law.impact, law.p_given, rate);
  const double depth = law.p_given / law.c_p - gap, approach = std::max(0.0, -rate);
  NormalForce f;
  f.spring = 0.5 * law.c_p * depth * depth;
  f.energy = f.spring - 0.5 * law.p_given * law.p_given / law.c_p;
  const double damping = law.d_p + law.hysteresis * law.c_p * depth;
  f.p = law.c_p * depth + damping * approach;
  f.energy_g = -law.c_p * depth;
  f.p_g = -law.c_p * (1 + law.hysteresis * approach);
  f.p_r = approach > 0 ? -damping : 0;
  f.power = damping * approach * approach;
  return f;
}

double unilateral_compliance(const Law& law, double fade) {
  return (law.compliance + 1 / std::max(fade, kLeastFade) - 1) / law.c_p;
}

double tangential_compliance(const Law& law) { return unilateral_compliance(law, 1) * law.c_p / law.c_t; }

Stuck stuck_on_spring(const Law& law, const Vector3d& z, double p, bool slid) {
  Stuck stuck{{}, slid ? law.mu : law.mu_static, p, slid, z};
  stuck.friction = sticking(z, law.c_t, stuck.mu * p);
  if (!stuck.friction.at_limit || slid) return stuck;
  stuck.mu = law.mu;
  stuck.friction = sticking(z, law.c_t, stuck.mu * p);
  return stuck;
}

TangentialForce tangential_force(const Law& law, const Stuck& stuck, const Vector3d& n) {
  TangentialForce f;
  f.T.col(0) = n.unitOrthogonal();
  f.T.col(1) = n.cross(f.T.col(0));
  f.t = -stuck.mu * stuck.p * f.T.transpose() * stuck.friction.direction;
  f.u = f.T.transpose() * stuck.z;
  f.c = tangential_compliance(law);
  f.mu_static = stuck.slid ? law.mu : law.mu_static;
  f.mu = law.mu;
  f.slides = stuck.friction.at_limit;
  f.K = f.T.transpose() * stuck.friction.K * f.T;
  return f;
}

void set_spring(const Law& law, const Stuck& stuck, ContactPoint& contact) {
  const Vector3d elastic = stuck.mu * stuck.p / law.c_t * stuck.friction.direction;
  const double force_t = stuck.mu * stuck.p * stuck.friction.direction.norm();
  contact.stick.slides = stuck.friction.at_limit;
  contact.elastic_slip = elastic;
  contact.energy += 0.5 * law.c_t * elastic.squaredNorm();
  contact.work += force_t * (stuck.z - elastic).norm();
  if (stuck.friction.at_limit) contact.friction_power = force_t * contact.slip.norm();
}

Gap gap(const ProjectionKinematics& kinematics, const FaceFunction& height, double offset,
        const FaceFunction& fade) {
  Gap result;
  static_cast<GapBy<15>&>(result) = smooth_gap<15>(kinematics, height, offset);
  result.fade = fade;
  result.direction = result.n;
  result.direction_x = result.n_x;
  result.g_x = result.n.transpose() * kinematics.G;
  return result;
}

GapBy<3> gap(const KinematicsBy<3>& kinematics, const FaceFunction& height, double offset) {
  return smooth_gap<3>(kinematics, height, offset);
}

void apply_law(const Law& law, const ProjectionKinematics& kinematics, const Gap& given,
               const StickMotion* stick, ContactPoint& contact) {
  Gap gap = given;
  gap.fade = fade_of(law, given.fade);
  const Parts all = parts(law, kinematics, gap, stick, contact);
  const Varying f = force(gap, all);
  contact.p = all.p;
  contact.g_n = gap.g;
  contact.n = gap.direction.normalized();
  contact.f = f.value;
  contact.F = (kinematics.G.transpose() * f.value).reshaped(3, 5);
  contact.slip = all.slip;
  contact.energy = (law.unilateral ? 1 : gap.fade.f) * all.normal.energy;
  contact.power = gap.fade.f * all.normal.power;
  contact.friction_power = 0;
  set_tangent(kinematics, f, force_directions(gap, all), contact);
  if (law.unilateral) set_unilateral(law, kinematics, gap, all, contact);
  if (law.impact) contact.g_x = gap.g_x.reshaped(3, 5);
  contact.fade = given.fade.f;
  const Gap& fading = law.impact ? given : gap;
  if (fading.fade.f < 1)
    add_boundary_force(boundary_force(kinematics, fading, fading_energy(law, kinematics, fading, all)),
                       contact);
  if (law.v_0 > 0) contact.friction_power = all.mu * all.p * all.friction.direction.dot(contact.slip);
  contact.work = all.normal.work;
  if (law.impact && given.fade.f < 1) {  // its compliance there stores what it takes
    contact.energy = 0.5 * (1 / std::max(given.fade.f, kLeastFade) - 1) / law.c_p * all.p * all.p;
    contact.work = 0;
  }
  contact.excess_rate = all.normal.excess_rate;
  if (!stick || law.c_t == 0) return;
  if (!law.unilateral)
    return set_spring(law, {all.friction, all.mu, all.p, stick->slides, all.motion.value}, contact);
  contact.tangential =
      tangential_force(law, {all.friction, all.mu, all.p, stick->slides, stick->u}, gap.n.normalized());
  contact.tangential->F_t = kinematics.G.transpose() * contact.tangential->T;
  contact.tangential->u_x = all.motion.x.transpose() * contact.tangential->T;
}

}  // namespace elastogear::contact
