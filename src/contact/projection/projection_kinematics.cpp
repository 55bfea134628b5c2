#include "contact/projection/projection_kinematics.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "elastogear/base/rotation.h"

namespace elastogear::contact {
namespace {

using Eigen::Vector3d;

void set_directions(const Face& face, const Projection& w, ProjectionKinematics& foot) {
  if (w.point.feature == Feature::vertex) return;
  if (w.point.feature == Feature::edge) {
    const int side = w.point.part, next = (side + 1) % face.sides;
    foot.n_dir = 1;
    foot.a.col(0) = face.x[next] - face.x[side];
    foot.N_a(side, 0) = -1;
    foot.N_a(next, 0) = 1;
    return;
  }
  const Shape s = shape(face.sides, w.point.u, w.point.v);
  foot.n_dir = 2;
  foot.a << combine(face, s.N_u), combine(face, s.N_v);
  foot.N_a << s.N_u, s.N_v;
  foot.N_uv = s.N_uv;
  foot.x_uv = combine(face, s.N_uv);
}

// The distance stays stationary: A dxi_alpha = a_alpha.(dd at fixed xi) + d.(da_alpha at fixed xi).
void set_motion(const Projection& w, ProjectionKinematics& foot) {
  const Local3 B = spread(1, -w.point.N);
  foot.A = foot.a.transpose() * foot.a;
  foot.A(0, 1) -= foot.d.dot(foot.x_uv);
  foot.A(1, 0) = foot.A(0, 1);
  for (int i = foot.n_dir; i < 2; ++i) foot.A(i, i) = 1;
  for (int i = 0; i < foot.n_dir; ++i)
    foot.D.row(i) = foot.a.col(i).transpose() * B + foot.d.transpose() * spread(0, foot.N_a.col(i));
  foot.D = (foot.A.inverse() * foot.D).eval();
  foot.d_x = B - foot.a * foot.D;
}

void set_normal(ProjectionKinematics& foot) {
  if (foot.n_dir < 2) {
    foot.n_x = (foot.d_x - foot.n * (foot.n.transpose() * foot.d_x)) / foot.g;
    return;
  }
  const Eigen::Matrix<double, 3, 2> dual = foot.a * (foot.a.transpose() * foot.a).inverse();
  const double b = foot.n.dot(foot.x_uv);
  foot.n_x.setZero();
  for (int i : {0, 1})
    foot.n_x -= dual.col(i) * (foot.n.transpose() * spread(0, foot.N_a.col(i)) + b * foot.D.row(1 - i));
}

// Angular velocity Omega of the face at the closest point (docs/theory.md, Eq. (6.13)): that of its normal
// and, about the normal, that of the edge or the mean of the tangents'.
void set_spin(const Face& face, const Projection& w, ProjectionKinematics& foot) {
  foot.spin.setZero();
  const Vector3d n = normal(face, w.point.u, w.point.v);
  if (n.isZero(0)) return;
  const Shape s = shape(face.sides, w.point.u, w.point.v);
  Eigen::Matrix<double, 3, 2> a;
  a << combine(face, s.N_u), combine(face, s.N_v);
  const Eigen::Matrix<double, 3, 2> dual = a * (a.transpose() * a).inverse();
  const bool edge = foot.n_dir == 1;
  for (int i : {0, 1}) {
    const Vector3d m = n.cross(dual.col(i));
    const Local3 rate = spread(0, i == 0 ? s.N_u : s.N_v);
    foot.spin -= m * (n.transpose() * rate);
    if (!edge) foot.spin += 0.5 * n * (m.transpose() * rate);
  }
  if (edge)
    foot.spin +=
        n * (n.cross(foot.a.col(0)).transpose() * spread(0, foot.N_a.col(0))) / foot.a.col(0).squaredNorm();
}

}  // namespace

Local3 spread(double slave, const Eigen::Vector4d& weight) {
  Local3 rows;
  rows.leftCols<3>() = slave * Eigen::Matrix3d::Identity();
  for (int i = 0; i < 4; ++i) rows.middleCols<3>(3 + 3 * i) = weight[i] * Eigen::Matrix3d::Identity();
  return rows;
}

Local3 tangent_derivative(const ProjectionKinematics& foot, int i) {
  return spread(0, foot.N_a.col(i)) + foot.x_uv * foot.D.row(1 - i);
}

Eigen::Matrix<double, 2, 15> metric_derivative(const ProjectionKinematics& foot, const Eigen::Vector2d& y) {
  Local3 a_x[2];
  for (int i = 0; i < foot.n_dir; ++i) a_x[i] = tangent_derivative(foot, i);
  const LocalRow twist_x = foot.x_uv.transpose() * foot.d_x + foot.d.transpose() * spread(0, foot.N_uv);
  Eigen::Matrix<double, 2, 15> change = Eigen::Matrix<double, 2, 15>::Zero();
  for (int i = 0; i < foot.n_dir; ++i) {
    for (int j = 0; j < foot.n_dir; ++j)
      change.row(i) += y[j] * (foot.a.col(j).transpose() * a_x[i] + foot.a.col(i).transpose() * a_x[j]);
    if (foot.n_dir == 2) change.row(i) -= y[1 - i] * twist_x;
  }
  return change;
}

ProjectionKinematics projection_kinematics(const Face& face, const Projection& projection,
                                           const Vector3d& x_slave) {
  ProjectionKinematics foot;
  foot.d = x_slave - projection.point.x;
  foot.n = projection.n;
  foot.g = projection.g_n;
  foot.N = projection.point.N;
  set_directions(face, projection, foot);
  set_motion(projection, foot);
  set_normal(foot);
  set_spin(face, projection, foot);
  foot.G = spread(1, -projection.point.N) + skew(foot.d) * foot.spin;
  return foot;
}

}  // namespace elastogear::contact
