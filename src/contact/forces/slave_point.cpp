#include "contact/forces/slave_point.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "elastogear/base/rotation.h"

namespace elastogear::contact {
namespace {

using SlaveRows = Eigen::Matrix<double, 3, 12>;
using FaceColumns = Eigen::Matrix<double, 24, Eigen::Dynamic, 0, 24, kColumns>;

// Velocity of the point by those of its nodes: sum_i N_i v_i + Omega x e. docs/theory, Eq. (6.26).
SlaveRows carried(const SlaveGeometry& s) {
  SlaveRows S = -skew(s.e) * face_spin(s.face, s.at[0], s.at[1]);
  for (int i = 0; i < 4; ++i) S.middleCols<3>(3 * i).diagonal().array() += s.N[i];
  return S;
}

// From rows of the point and four master nodes to rows of four slave and four master nodes.
template <class Columns>
FaceColumns on_nodes(const SlaveRows& S, const Columns& c) {
  FaceColumns all(24, c.cols());
  all.template topRows<12>() = S.transpose().lazyProduct(c.template topRows<3>());
  all.template bottomRows<12>() = c.template bottomRows<12>();
  return all;
}

LocalVectors vectors_on_nodes(const SlaveRows& S, const LocalVectors& v) {
  LocalVectors all(3, 8);
  all.leftCols<4>() = (S.transpose() * v.col(0)).reshaped(3, 4);
  all.rightCols<4>() = v.rightCols<4>();
  return all;
}

// Change of F per xi at unchanged p, as the point moves over its face.
Eigen::Matrix<double, 24, 1> force_along(const SlaveGeometry& s, const SlaveRows& S, int i,
                                         const ContactPoint& c) {
  const Local moved = (Local() << s.a.col(i), Eigen::Matrix<double, 12, 1>::Zero()).finished();
  Local F_xi = -c.W * (c.k * (c.V.transpose() * moved));
  if (c.c > 0) F_xi += c.F_p.reshaped() * (c.g_x.col(0).dot(s.a.col(i)) / c.c);
  Eigen::Matrix<double, 24, 1> all = on_nodes(S, F_xi);
  for (int node = 0; node < 4; ++node) all.segment<3>(3 * node) += s.N_a(node, i) * c.F.col(0);
  return all;
}

// Second derivatives of the gap by xi and the local coordinates.
Eigen::Matrix<double, 24, 2> mixed_derivatives(const SlaveGeometry& s, const SlaveRows& S, int n_dir,
                                               const Gap& gap) {
  Eigen::Matrix<double, 24, 2> g_x_xi = Eigen::Matrix<double, 24, 2>::Zero();
  for (int i = 0; i < n_dir; ++i) {
    auto column = g_x_xi.col(i);
    column.head<12>() = S.transpose() * (gap.n_x.leftCols<3>() * s.a.col(i));
    for (int node = 0; node < 4; ++node) column.segment<3>(3 * node) += s.N_a(node, i) * gap.n;
    column.tail<12>() = gap.n_x.rightCols<12>().transpose() * s.a.col(i);
  }
  return g_x_xi;
}

// Motion of the point along its directions by the nodes, -k V' dx.
struct Following {
  Eigen::Matrix<double, 24, 2> V;
  Eigen::Matrix2d k;
};

void spread(const SlaveGeometry& s, int n_dir, const Following& following, ContactPoint& c) {
  const SlaveRows S = carried(s);
  const Eigen::Index n = c.W.cols(), all = n + n_dir;
  FaceColumns W(24, all), V(24, all), V_dot = FaceColumns::Zero(24, all);
  LocalStiffness k = LocalStiffness::Zero(all, all);
  W.leftCols(n) = on_nodes(S, c.W);
  V.leftCols(n) = on_nodes(S, c.V);
  V_dot.leftCols(n) = on_nodes(S, c.V_dot);
  k.topLeftCorner(n, n) = c.k;
  for (int i = 0; i < n_dir; ++i) W.col(n + i) = force_along(s, S, i, c);
  V.rightCols(n_dir) = following.V.leftCols(n_dir);
  k.bottomRightCorner(n_dir, n_dir) = following.k.topLeftCorner(n_dir, n_dir);
  c.W = W;
  c.V = V;
  c.V_dot = V_dot;
  c.k = k;
  for (LocalVectors* vectors : {&c.F, &c.F_p, &c.g_x})
    if (vectors->cols() > 0) *vectors = vectors_on_nodes(S, *vectors);
  c.slave_N = s.N;
}

// The force p (F_p - slope b_x) in place of p F_p, with its gap's gradient and tangent.
void turn_along_side(double slope, const LocalRow& b_x, const LocalVectors& F_p, const LocalRow& g_x,
                     double per_gap, ContactPoint& c) {
  const LocalVectors along = slope * b_x.reshaped(3, 5);
  const Eigen::Index n = c.W.cols();
  LocalColumns W = LocalColumns::Zero(15, n + 2), V = W, V_dot = W;
  LocalStiffness k = LocalStiffness::Zero(n + 2, n + 2);
  W.leftCols(n) = c.W;
  V.leftCols(n) = c.V;
  if (c.V_dot.cols() > 0) V_dot.leftCols(n) = c.V_dot;
  k.topLeftCorner(n, n) = c.k;
  W.rightCols(2) << F_p.reshaped(), (F_p - along).reshaped();
  V.rightCols(2) << g_x.transpose(), g_x.transpose() - along.reshaped();
  k.diagonal().tail(2) << -per_gap, per_gap;
  c.W = W;
  c.V = V;
  c.V_dot = V_dot;
  c.k = k;
  c.F -= c.p * along;
  c.f = c.F.col(0);
  for (LocalVectors* vectors : {&c.F_p, &c.g_x})
    if (vectors->cols() > 0) *vectors -= along;
}

}  // namespace

SlaveGeometry slave_geometry(const SurfaceView& slave, const Heights& heights, const SlavePoint& point) {
  Face face = face_of(slave, point.face);
  face.extension = {};
  const Shape shapes = shape(face.sides, point.at[0], point.at[1]);
  const FaceFunction h =
      heights.empty() ? FaceFunction{} : height(heights, face.sides, point.face, point.at[0], point.at[1]);
  SlaveGeometry s;
  s.face = face;
  s.at = point.at;
  s.N = shapes.N;
  s.n = normal(face, point.at[0], point.at[1]);
  s.e = h.f * s.n;
  s.x = combine(face, s.N) + s.e;
  Eigen::Matrix<double, 3, 2> x_a;
  x_a << combine(face, shapes.N_u) + h.f_a[0] * s.n, combine(face, shapes.N_v) + h.f_a[1] * s.n;
  const Eigen::Vector3d twist = combine(face, shapes.N_uv);
  for (int i = 0; i < point.n_dir; ++i) {
    const Eigen::Vector2d along = point.along.col(i);
    s.N_a.col(i) = along[0] * shapes.N_u + along[1] * shapes.N_v;
    s.a.col(i) = x_a * along;
    for (int j = 0; j < point.n_dir; ++j) {
      const Eigen::Vector2d other = point.along.col(j);
      s.a_b[i][j] = (along[0] * other[1] + along[1] * other[0]) * twist + along.dot(h.f_ab * other) * s.n;
    }
  }
  return s;
}

Eigen::Matrix<double, 3, 2> corner_tangents(const SurfaceView& slave, const Heights& heights, int f,
                                            int corner) {
  const Face face = face_of({slave.face, slave.topology, slave.x, 0}, f);
  const Eigen::Vector2d at = on_side(face.sides, corner, 0);
  const Shape s = shape(face.sides, at[0], at[1]);
  Eigen::Matrix<double, 3, 2> a;
  a << combine(face, s.N_u), combine(face, s.N_v);
  if (!heights.empty()) a += a.col(0).cross(a.col(1)).normalized() * heights.slope[f].col(corner).transpose();
  return a;
}

Eigen::Matrix<double, 3, 24> on_nodes_of_faces(const SlaveGeometry& s, const Local3& by_point) {
  Eigen::Matrix<double, 3, 24> rows;
  rows << by_point.leftCols<3>() * carried(s), by_point.rightCols<12>();
  return rows;
}

Eigen::Matrix2d gap_curvature(const SlaveGeometry& s, int n_dir, const GapBy<3>& gap) {
  Eigen::Matrix2d curvature = Eigen::Matrix2d::Identity();
  for (int i = 0; i < n_dir; ++i) {
    const Eigen::Vector3d turn = gap.n_x * s.a.col(i);
    for (int j = 0; j < n_dir; ++j) curvature(i, j) = s.a.col(j).dot(turn) + gap.n.dot(s.a_b[i][j]);
  }
  return curvature;
}

namespace {

// Is the point's tangent F_p c^-1 g_x' alone? A force that is zero does not turn.
bool is_without_force(const ContactPoint& c) {
  return c.c > 0 && c.p == 0 && c.fade == 1 && !c.tangential && (c.W.col(0) - c.F_p.reshaped()).isZero(0);
}

void spread_without_force(const SlaveGeometry& s, ContactPoint& c) {
  const SlaveRows S = carried(s);
  for (LocalVectors* vectors : {&c.F, &c.F_p, &c.g_x}) *vectors = vectors_on_nodes(S, *vectors);
  c.W = c.F_p.reshaped();
  c.V = c.g_x.reshaped();
  c.V_dot = LocalColumns::Zero(24, 1);
  c.k = LocalStiffness::Constant(1, 1, 1 / c.c);
  c.slave_N = s.N;
}

}  // namespace

// The point follows the nodes: docs/theory, Eq. (6.27).
void spread_over_face(const SlaveGeometry& s, int n_dir, const Gap& gap, ContactPoint& c) {
  if (is_without_force(c)) return spread_without_force(s, c);
  const Eigen::Matrix2d curvature = gap_curvature(s, n_dir, {gap.g, gap.n, gap.n_x.leftCols<3>()});
  Following following{mixed_derivatives(s, carried(s), n_dir, gap), Eigen::Matrix2d::Identity()};
  following.k.topLeftCorner(n_dir, n_dir) = curvature.topLeftCorner(n_dir, n_dir).inverse();
  spread(s, n_dir, following, c);
}

LocalRow way_across(const Crossing& crossing, const ProjectionKinematics& kinematics) {
  return crossing.outward.transpose() * kinematics.D;
}

// docs/theory, Eq. (6.27b).
void spread_crossing(const SlaveGeometry& s, const Crossing& crossing, const OpenPoint& open, double per_gap,
                     ContactPoint& c) {
  const LocalRow b_x = way_across(crossing, open.kinematics);
  const Eigen::Vector3d a = s.a.col(0);
  const double across = b_x.head<3>().dot(a);
  const LocalVectors F_p =
      c.c > 0 ? c.F_p : LocalVectors((open.kinematics.G.transpose() * open.gap.direction).reshaped(3, 5));
  const LocalRow g_x = c.c > 0 ? LocalRow(c.g_x.reshaped().transpose()) : open.gap.g_x;
  turn_along_side(open.gap.n.dot(a) / across, b_x, F_p, g_x, c.c > 0 ? 1 / c.c : per_gap, c);
  Following following{Eigen::Matrix<double, 24, 2>::Zero(), Eigen::Matrix2d::Identity()};
  following.V.col(0) << carried(s).transpose() * b_x.head<3>().transpose(), b_x.tail<12>().transpose();
  following.k(0, 0) = 1 / across;
  spread(s, 1, following, c);
}

}  // namespace elastogear::contact
