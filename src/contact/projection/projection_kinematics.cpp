#include "contact/projection/projection_kinematics.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "elastogear/base/rotation.h"

namespace elastogear::contact {
namespace {

using Eigen::Vector3d;

// The first columns of [slave I, weight_i I].
template <int kColumns>
Eigen::Matrix<double, 3, kColumns> columns(double slave, const Eigen::Vector4d& weight) {
  Eigen::Matrix<double, 3, kColumns> rows;
  rows.template leftCols<3>() = slave * Eigen::Matrix3d::Identity();
  for (int i = 0; 3 + 3 * i < kColumns; ++i)
    rows.template middleCols<3>(3 + 3 * i) = weight[i] * Eigen::Matrix3d::Identity();
  return rows;
}

template <int kColumns>
void set_directions(const Face& face, const Projection& w, KinematicsBy<kColumns>& kinematics) {
  if (w.point.feature == Feature::vertex) return;
  if (w.point.feature == Feature::edge) {
    const int side = w.point.part, next = (side + 1) % face.sides;
    kinematics.n_dir = 1;
    kinematics.a.col(0) = face.x[next] - face.x[side];
    kinematics.N_a(side, 0) = -1;
    kinematics.N_a(next, 0) = 1;
    return;
  }
  const Shape s = shape(face.sides, w.point.u, w.point.v);
  kinematics.n_dir = 2;
  kinematics.a << combine(face, s.N_u), combine(face, s.N_v);
  kinematics.N_a << s.N_u, s.N_v;
  kinematics.N_uv = s.N_uv;
  kinematics.x_uv = combine(face, s.N_uv);
}

// The distance stays stationary: A dxi_alpha = a_alpha.(dd at fixed xi) + d.(da_alpha at fixed xi).
template <int kColumns>
void set_motion(const Projection& w, KinematicsBy<kColumns>& kinematics) {
  const Eigen::Matrix<double, 3, kColumns> B = columns<kColumns>(1, -w.point.N);
  kinematics.A = kinematics.a.transpose() * kinematics.a;
  kinematics.A(0, 1) -= kinematics.d.dot(kinematics.x_uv);
  kinematics.A(1, 0) = kinematics.A(0, 1);
  for (int i = kinematics.n_dir; i < 2; ++i) kinematics.A(i, i) = 1;
  for (int i = 0; i < kinematics.n_dir; ++i)
    kinematics.D.row(i) = kinematics.a.col(i).transpose() * B +
                          kinematics.d.transpose() * columns<kColumns>(0, kinematics.N_a.col(i));
  kinematics.D = (kinematics.A.inverse() * kinematics.D).eval();
  kinematics.d_x = B - kinematics.a * kinematics.D;
}

template <int kColumns>
void set_normal(const Vector3d& x_slave, KinematicsBy<kColumns>& kinematics) {
  kinematics.n_x.setZero();
  if (kinematics.n_dir < 2) {
    if (vanishes(kinematics.d, x_slave)) return;
    kinematics.n_x =
        (kinematics.d_x - kinematics.n * (kinematics.n.transpose() * kinematics.d_x)) / kinematics.g;
    return;
  }
  const Eigen::Matrix<double, 3, 2> dual = kinematics.a * (kinematics.a.transpose() * kinematics.a).inverse();
  const double b = kinematics.n.dot(kinematics.x_uv);
  for (int i : {0, 1})
    kinematics.n_x -= dual.col(i) * (kinematics.n.transpose() * columns<kColumns>(0, kinematics.N_a.col(i)) +
                                     b * kinematics.D.row(1 - i));
}

template <int kColumns>
void set_kinematics(const Face& face, const Projection& projection, const Vector3d& x_slave,
                    KinematicsBy<kColumns>& kinematics) {
  kinematics.d = x_slave - projection.point.x;
  kinematics.n = projection.n;
  kinematics.g = projection.g_n;
  kinematics.N = projection.point.N;
  set_directions(face, projection, kinematics);
  set_motion(projection, kinematics);
  set_normal(x_slave, kinematics);
}

// Angular velocity Omega of the face at the closest point (docs/theory, Eq. (6.13)): that of its normal
// and, about the normal, that of the edge or the mean of the tangents'.
void set_spin(const Face& face, const Projection& w, ProjectionKinematics& kinematics) {
  kinematics.spin.setZero();
  kinematics.spin.rightCols<12>() = face_spin(face, w.point.u, w.point.v);
  if (kinematics.n_dir != 1) return;
  const Vector3d n = normal(face, w.point.u, w.point.v), a = kinematics.a.col(0);
  kinematics.spin -= n * (n.transpose() * kinematics.spin);
  kinematics.spin += n * (n.cross(a).transpose() * spread(0, kinematics.N_a.col(0))) / a.squaredNorm();
}

}  // namespace

Local3 spread(double slave, const Eigen::Vector4d& weight) { return columns<15>(slave, weight); }

Eigen::Matrix<double, 3, 12> face_spin(const Face& face, double u, double v) {
  Eigen::Matrix<double, 3, 12> spin = Eigen::Matrix<double, 3, 12>::Zero();
  const Vector3d n = normal(face, u, v);
  if (n.isZero(0)) return spin;
  const Shape s = shape(face.sides, u, v);
  Eigen::Matrix<double, 3, 2> a;
  a << combine(face, s.N_u), combine(face, s.N_v);
  const Eigen::Matrix<double, 3, 2> dual = a * (a.transpose() * a).inverse();
  for (int i : {0, 1}) {
    const Vector3d m = n.cross(dual.col(i));
    const Eigen::Matrix3d turn = 0.5 * n * m.transpose() - m * n.transpose();
    for (int node = 0; node < 4; ++node)
      spin.middleCols<3>(3 * node) += (i == 0 ? s.N_u : s.N_v)[node] * turn;
  }
  return spin;
}

template <int kColumns>
Eigen::Matrix<double, 3, kColumns> tangent_derivative(const KinematicsBy<kColumns>& kinematics, int i) {
  return columns<kColumns>(0, kinematics.N_a.col(i)) + kinematics.x_uv * kinematics.D.row(1 - i);
}

template <int kColumns>
Eigen::Matrix<double, 2, kColumns> metric_derivative(const KinematicsBy<kColumns>& kinematics,
                                                     const Eigen::Vector2d& y) {
  Eigen::Matrix<double, 3, kColumns> a_x[2];
  for (int i = 0; i < kinematics.n_dir; ++i) a_x[i] = tangent_derivative(kinematics, i);
  const Eigen::Matrix<double, 1, kColumns> twist_x =
      kinematics.x_uv.transpose() * kinematics.d_x +
      kinematics.d.transpose() * columns<kColumns>(0, kinematics.N_uv);
  Eigen::Matrix<double, 2, kColumns> change = Eigen::Matrix<double, 2, kColumns>::Zero();
  for (int i = 0; i < kinematics.n_dir; ++i) {
    for (int j = 0; j < kinematics.n_dir; ++j)
      change.row(i) +=
          y[j] * (kinematics.a.col(j).transpose() * a_x[i] + kinematics.a.col(i).transpose() * a_x[j]);
    if (kinematics.n_dir == 2) change.row(i) -= y[1 - i] * twist_x;
  }
  return change;
}

template Local3 tangent_derivative(const KinematicsBy<15>&, int);
template Eigen::Matrix3d tangent_derivative(const KinematicsBy<3>&, int);
template Eigen::Matrix<double, 2, 15> metric_derivative(const KinematicsBy<15>&, const Eigen::Vector2d&);
template Eigen::Matrix<double, 2, 3> metric_derivative(const KinematicsBy<3>&, const Eigen::Vector2d&);

KinematicsBy<3> slave_kinematics(const Face& face, const Projection& projection, const Vector3d& x_slave) {
  KinematicsBy<3> kinematics;
  set_kinematics(face, projection, x_slave, kinematics);
  return kinematics;
}

ProjectionKinematics projection_kinematics(const Face& face, const Projection& projection,
                                           const Vector3d& x_slave) {
  ProjectionKinematics kinematics;
  set_kinematics(face, projection, x_slave, static_cast<KinematicsBy<15>&>(kinematics));
  set_spin(face, projection, kinematics);
  kinematics.G = spread(1, -projection.point.N) + skew(kinematics.d) * kinematics.spin;
  return kinematics;
}

}  // namespace elastogear::contact
