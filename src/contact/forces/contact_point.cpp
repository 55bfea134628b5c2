#include "contact/forces/contact_point.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "contact/forces/force_direction.h"
#include "contact/forces/tangent.h"
#include "elastogear/base/rotation.h"

namespace elastogear::contact {
namespace {

using Eigen::Vector3d;

// A point may lie beside the face that it was on by this share of the face until it leaves it.
constexpr double kKept = 5e-5;

ContactPoint geometry(const SurfaceView& master, const Projection& w) {
  const int sides = side_count(master.face, w.face);
  const Eigen::Vector2d natural = natural_coordinates(sides, w.point.u, w.point.v);
  ContactPoint contact;
  contact.face = w.face;
  contact.master_nodes = master.face.col(w.face);
  contact.N = w.point.N;
  contact.xi = natural[0];
  contact.eta = natural[1];
  contact.n = w.n;
  contact.g_n = w.g_n;
  return contact;
}

Projection smooth_projection(const MasterSide& master, const Projection& w, const Vector3d& q) {
  const bool on_face = w.point.feature == Feature::face;
  if (master.heights.empty() || on_face) return w;
  const Face face = face_of(master.surface, w.face);
  if (normal(face, w.point.u, w.point.v).dot(w.n) < std::cos(master.feature_angle)) return w;
  return extended_projection(face, q, w).value_or(w);
}

// A function of (u, v) restricted to the directions in which the closest point can move.
FaceFunction restricted(const FaceFunction& full, int sides, const Projection& w) {
  if (w.point.feature == Feature::face) return full;
  if (w.point.feature == Feature::vertex) return {full.f};
  const Eigen::Vector2d along = on_side(sides, w.point.part, 1) - on_side(sides, w.point.part, 0);
  FaceFunction side{full.f};
  side.f_a[0] = full.f_a.dot(along);
  side.f_ab(0, 0) = along.dot(full.f_ab * along);
  return side;
}

FaceFunction height_at(const MasterSide& master, const Face& face, const Projection& w) {
  if (master.heights.empty()) return {};
  return restricted(height(master.heights, face.sides, w.face, w.point.u, w.point.v), face.sides, w);
}

FaceFunction fade_at(const MasterSide& master, const Face& face, const Projection& w) {
  if (!master.fades) return {1};
  return restricted(fade_factor(face, w.point.u, w.point.v), face.sides, w);
}

// Displacement of the closest point over the master since the last step, and the stretch of the spring then.
// docs/theory, Eq. (6.18).
StickMotion stick_motion(const SurfaceView& master, const StickPoint& stuck, const Projection& w,
                         const ProjectionKinematics& kinematics) {
  const Face face = face_of(master, stuck.face);
  const Shape s = shape(face.sides, stuck.u, stuck.v);
  const Eigen::Vector4d anchor = s.N - stuck.e_u * s.N_u - stuck.e_v * s.N_v;
  StickMotion motion;
  motion.slides = stuck.slides;
  motion.u = w.point.x - combine(face, anchor);
  motion.u_x = kinematics.a * kinematics.D;
  if (stuck.face == w.face)
    motion.u_x += spread(0, w.point.N - anchor);
  else  // the anchor's own nodes are not among the local ones: it turns with the present face
    motion.u_x -= skew(motion.u) * kinematics.spin;
  return motion;
}

// Local coordinates of a tangential vector: 2 x 3, 1/m.
Eigen::Matrix<double, 2, 3> on_face(const Shape& s, const Face& face) {
  Eigen::Matrix<double, 3, 2> a;
  a << combine(face, s.N_u), combine(face, s.N_v);
  return (a.transpose() * a).inverse() * a.transpose();
}

bool share_a_node(const SurfaceView& surface, int a, int b) {
  const Eigen::Vector4i other = surface.face.col(b);
  const auto nodes = surface.face.col(a);
  return std::any_of(nodes.begin(), nodes.end(), [&](int node) { return (other.array() == node).any(); });
}

}  // namespace

void set_stick_point(const Face& face, int number, const Eigen::Vector2d& at, ContactPoint& contact) {
  StickPoint& point = contact.stick;
  point.face = number;
  point.u = at[0];
  point.v = at[1];
  const auto local = on_face(shape(face.sides, at[0], at[1]), face);
  if (contact.tangential) contact.tangential->on_face = local * contact.tangential->T;
  const Eigen::Vector2d e = local * contact.elastic_slip;
  if (e.allFinite()) point.e_u = e[0], point.e_v = e[1];
}

Projection kept_projection(const MasterSide& master, const Projection& now, const Vector3d& x, int before) {
  if (master.heights.empty() || before == now.face || !share_a_node(master.surface, before, now.face))
    return now;
  const Face face = face_of(master.surface, before);
  const ClosestPoint nearest = closest_point(face, x);
  const Vector3d n = normal(face, nearest.u, nearest.v);
  if (nearest.feature == Feature::outside || n.dot(now.n) < std::cos(master.feature_angle)) return now;
  if (nearest.feature == Feature::face)  // of both, as above a concave edge
    return now.point.N.minCoeff() < kKept ? Projection{before, nearest, n, n.dot(x - nearest.x)} : now;
  const auto kept = extended_projection(face, x, {before, nearest, {}, 0});
  return kept && kept->point.N.minCoeff() > -kKept ? *kept : now;
}

bool on_extension(const Projection& w) { return w.point.N.minCoeff() < 0; }

ContactPoint potential_contact(const MasterSide& master, const Projection& w, const Law& law,
                               bool full_tangent) {
  const Face face = face_of(master.surface, w.face);
  ContactPoint contact = geometry(master.surface, w);
  contact.p = law.unilateral ? law.p_given : -law.c_p * w.g_n;
  contact.f = contact.p * w.n;
  contact.F.resize(3, 5);
  contact.F << contact.f, -contact.f * w.point.N.transpose();
  contact.energy = 0.5 * law.c_p * w.g_n * w.g_n;
  double k = law.c_p;
  if (law.unilateral) {
    contact.c = unilateral_compliance(law, 1);
    contact.F_p.resize(3, 5);
    contact.F_p << w.n, -w.n * w.point.N.transpose();
    contact.g_x = contact.F_p;
    contact.energy = 0.5 * contact.c * law.p_given * law.p_given;
    k = 1 / contact.c;
  }
  Tangent tangent = contact_tangent(face, w, {contact.p, k}, full_tangent);
  contact.W = std::move(tangent.W);
  contact.V_dot.resize(15, 0);
  contact.k = tangent.k;
  return contact;
}

PointGap point_gap(const MasterSide& master, const Projection& projection, const Vector3d& x, double offset) {
  const Projection w = smooth_projection(master, projection, x);
  const Face face = face_of(master.surface, w.face);
  return {w, gap(slave_kinematics(face, w, x), height_at(master, face, w), offset)};
}

double size_of_gap(const MasterSide& master, const Projection& projection, const Vector3d& x, double offset) {
  const Projection w = smooth_projection(master, projection, x);
  return w.g_n - height_at(master, face_of(master.surface, w.face), w).f + offset;
}

OpenPoint open_point(const MasterSide& master, const Projection& projection, const Vector3d& x,
                     double offset) {
  OpenPoint open;
  open.projection = smooth_projection(master, projection, x);
  const Projection& w = open.projection;
  const Face face = face_of(master.surface, w.face);
  open.kinematics = projection_kinematics(face, w, x);
  open.gap = gap(open.kinematics, height_at(master, face, w), offset, fade_at(master, face, w));
  if (!master.blends || w.point.feature != Feature::face) return open;
  const ForceDirection gradient{open.gap.n, open.gap.n_x.leftCols<3>()};
  const ForceDirection direction = force_direction(master, w, x, gradient, open.kinematics.D.leftCols<3>());
  open.gap.direction = direction.n;
  open.gap.direction_x += (direction.n_q - gradient.n_q) * spread(1, -w.point.N);
  return open;
}

std::optional<ContactPoint> general_contact(const MasterSide& master, const OpenPoint& open,
                                            const SlaveContact& slave, const Law& law) {
  if (is_open(law, open.gap.g)) return {};
  const Projection& w = open.projection;
  ContactPoint contact = geometry(master.surface, w);
  contact.v.resize(3, 5);
  contact.v.col(0) = slave.v;
  for (int i = 0; i < 4; ++i) contact.v.col(1 + i) = slave.master_velocity(contact.master_nodes[i]);
  std::optional<StickMotion> motion;
  if (slave.stuck) {
    motion = stick_motion(master.surface, *slave.stuck, w, open.kinematics);
    motion->given = slave.friction;
  }
  apply_law(law, open.kinematics, open.gap, motion ? &*motion : nullptr, contact);
  set_stick_point(face_of(master.surface, w.face), w.face, {w.point.u, w.point.v}, contact);
  return contact;
}

}  // namespace elastogear::contact
