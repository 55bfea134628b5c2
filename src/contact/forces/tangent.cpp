#include "contact/forces/tangent.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>

namespace elastogear::contact {
namespace {

using Column = Eigen::Matrix<double, 15, 1>;

// The column [slave a; weight_i a].
Column column(double slave, const Eigen::Vector4d& weight, const Eigen::Vector3d& a) {
  Column c;
  c.head<3>() = slave * a;
  for (int i = 0; i < 4; ++i) c.segment<3>(3 + 3 * i) = weight[i] * a;
  return c;
}

// A tangent with room for W, whose entries are still to be set, and k = 0.
Tangent empty_tangent(int n_columns) {
  Tangent t;
  t.W.resize(15, n_columns);
  t.k.setZero(n_columns, n_columns);
  return t;
}

// Stiffness across n of the force towards a line or point at the distance |g_n|: it has the direction of the
// distance. A distance that cannot be told from the one that the force makes is taken for that.
double across(const Projection& w, const NormalStiffness& normal) {
  return normal.p > 0 ? normal.p / std::max(-w.g_n, normal.p / normal.k) : 0;
}

Tangent normal_part(const Projection& w, const NormalStiffness& normal) {
  Tangent t = empty_tangent(1);
  t.W = column(1, -w.point.N, w.n);
  t.k(0, 0) = normal.k;
  return t;
}

// The closest point is inside the face: W = [N, D_1, D_2, N_1, N_2]. docs/theory, Eq. (6.7).
Tangent face_tangent(const Face& face, const Projection& w, const NormalStiffness& normal) {
  const Shape s = shape(face.sides, w.point.u, w.point.v);
  const Eigen::Vector3d a_u = combine(face, s.N_u), a_v = combine(face, s.N_v);
  const double twist = w.n.dot(combine(face, s.N_uv));
  Eigen::Matrix2d m, b;
  m << a_u.squaredNorm(), a_u.dot(a_v), a_u.dot(a_v), a_v.squaredNorm();
  b << 0, twist, twist, 0;
  Eigen::Matrix<double, 15, 2> T, N_alpha;
  T << column(1, -s.N, a_u), column(1, -s.N, a_v);
  N_alpha << column(0, -s.N_u, w.n), column(0, -s.N_v, w.n);
  const double g = w.g_n, p = normal.p;
  const Eigen::Matrix2d A = m - g * b, m_inverse = m.inverse(), I = Eigen::Matrix2d::Identity();

  Tangent t = empty_tangent(5);
  t.W << column(1, -s.N, w.n), (T - g * N_alpha) * A.inverse(), N_alpha;
  t.k(0, 0) = normal.k;
  t.k.block<2, 2>(1, 1) = -p * (g * b * m_inverse * b - b);
  t.k.block<2, 2>(1, 3) = -p * (I - g * b * m_inverse);
  t.k.block<2, 2>(3, 1) = t.k.block<2, 2>(1, 3).transpose();
  t.k.block<2, 2>(3, 3) = -p * g * m_inverse;
  return t;
}

// The closest point is on a side: W = [V_n, V_p, V_e, E_n], with the side's direction e and p = n x e.
// docs/theory, Eq. (6.8).
Tangent edge_tangent(const Face& face, const Projection& w, const NormalStiffness& normal) {
  const int side = w.point.part, next = (side + 1) % face.sides;
  const Eigen::Vector3d along = face.x[next] - face.x[side];
  const double length = along.norm(), g = w.g_n;
  const Eigen::Vector3d e = along / length;
  Eigen::Vector4d ends = Eigen::Vector4d::Zero();
  ends[side] = -1;
  ends[next] = 1;

  Tangent t = empty_tangent(4);
  t.W << column(1, -w.point.N, w.n), column(1, -w.point.N, w.n.cross(e)), column(1, -w.point.N, e),
      column(0, ends, w.n);
  t.k(0, 0) = normal.k;
  t.k(1, 1) = across(w, normal);
  t.k(2, 3) = t.k(3, 2) = normal.p / length;
  t.k(3, 3) = normal.p * g / (length * length);
  return t;
}

// The closest point is a corner: a spring between two nodes.
Tangent vertex_tangent(const Projection& w, const NormalStiffness& normal) {
  const Eigen::Vector3d p = w.n.unitOrthogonal();
  Tangent t = empty_tangent(3);
  t.W << column(1, -w.point.N, w.n), column(1, -w.point.N, p), column(1, -w.point.N, w.n.cross(p));
  t.k.diagonal() << normal.k, across(w, normal), across(w, normal);
  return t;
}

}  // namespace

Tangent contact_tangent(const Face& face, const Projection& projection, const NormalStiffness& normal,
                        bool full) {
  if (!full) return normal_part(projection, normal);
  switch (projection.point.feature) {
    case Feature::edge:
      return edge_tangent(face, projection, normal);
    case Feature::vertex:
      return vertex_tangent(projection, normal);
    default:
      return face_tangent(face, projection, normal);
  }
}

}  // namespace elastogear::contact
