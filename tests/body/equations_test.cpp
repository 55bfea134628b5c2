// The equations of motion against Hamilton's equations of their own kinetic energy, differenced numerically.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"
#include "elastogear/body/deformed_inertia.h"
#include "elastogear/body/tangent.h"
#include "joints.h"
#include "random_body.h"

namespace elastogear::equations_test {
using body::Equations;
using body::Force;
using body::InertiaLevel;
using body::JointType;
using body::Motion;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kRoundoff = 1e-13;
constexpr double kTwiceDifferenced = 1e-6;  // quantities are of order one to a hundred
const Vector3d kGravity(1, -2, 3);

struct Case {
  JointType type;
  InertiaLevel level;
};

Equations equations(const Case& c) {
  return make_equations(test::random_body(), test::joint_of(c.type), c.level);
}

Motion some_motion(int n_s) {
  std::srand(2);
  Motion m;
  for (VectorXd* x : {&m.s, &m.s_dot, &m.s_ddot}) *x = VectorXd::Random(n_s);
  for (VectorXd* x : {&m.q, &m.q_dot, &m.q_ddot}) *x = 0.3 * VectorXd::Random(test::kModes);
  return m;
}

// The motion a time h later, with the same accelerations. Free: psi advances by the inverse tangent.
Motion later(const Equations& eq, const Motion& m, double h) {
  Motion n = m;
  n.s += h * m.s_dot + h * h / 2 * m.s_ddot;
  if (has_rotation_vector(eq.joint.type)) {
    const Vector3d psi = m.s.tail<3>(), w = m.s_dot.tail<3>();
    n.s.tail<3>() = psi + h * cayley_tangent(psi).inverse() * w;  // to first order
  }
  n.s_dot += h * m.s_ddot;
  n.q += h * m.q_dot + h * h / 2 * m.q_ddot;
  n.q_dot += h * m.q_ddot;
  return n;
}

template <class F>
auto difference(const F& f, double h) {
  return ((f(h) - f(-h)) / (2 * h)).eval();
}

struct EquationsOfMotion : testing::TestWithParam<Case> {};
// All levels but constant, whose equations are those of a kinetic energy.
struct DeformableInertia : testing::TestWithParam<Case> {};

// Newton and Euler for the body as a whole: independent of how the equations are written.
TEST_P(DeformableInertia, changes_the_momentum_by_the_forces) {
  const Equations eq = equations({JointType::free, GetParam().level});
  const Motion m = some_motion(6);
  const Force inertia = inertia_force(eq, m), quadratic = quadratic_force(eq, m);
  const auto [r_WB, R_WB] = placement(eq.joint, m.s);
  const Vector3d force = R_WB * (inertia.s - quadratic.s).head<3>(),
                 torque = r_WB.cross(force) + R_WB * (inertia.s - quadratic.s).tail<3>();
  const auto p = [&](double h) { return momentum(eq, later(eq, m, h)).linear; };
  const auto L = [&](double h) { return momentum(eq, later(eq, m, h)).angular; };
  EXPECT_LT((difference(p, 1e-5) - force).norm(), kTwiceDifferenced);
  EXPECT_LT((difference(L, 1e-5) - torque).norm(), kTwiceDifferenced);
}

TEST_P(DeformableInertia, has_the_rate_of_kinetic_energy_as_its_power) {
  const Equations eq = equations(GetParam());
  const Motion m = some_motion(static_cast<int>(eq.n_s()));
  const Force inertia = inertia_force(eq, m), quadratic = quadratic_force(eq, m);
  const body::FrameMotion f = frame_motion(eq, m);
  const VectorXd velocity =
      eq.joint.type == JointType::free ? VectorXd((VectorXd(6) << f.v, f.w).finished()) : m.s_dot;
  const double power = velocity.dot(inertia.s - quadratic.s) + m.q_dot.dot(inertia.q - quadratic.q);
  const auto T = [&](double h) { return Eigen::Matrix<double, 1, 1>(kinetic_energy(eq, later(eq, m, h))); };
  EXPECT_NEAR(power, difference(T, 1e-5)(0), kTwiceDifferenced);
}

TEST_P(DeformableInertia, gives_the_equations_of_q_from_the_kinetic_energy) {
  const Equations eq = equations(GetParam());
  const Motion m = some_motion(static_cast<int>(eq.n_s()));
  const Force inertia = inertia_force(eq, m), quadratic = quadratic_force(eq, m);
  for (int k = 0; k < test::kModes; ++k) {
    const auto slope = [&](const Motion& at, VectorXd Motion::*x) {
      const auto T = [&](double h) {
        Motion n = at;
        (n.*x)[k] += h;
        return Eigen::Matrix<double, 1, 1>(kinetic_energy(eq, n));
      };
      return difference(T, 1e-2)(0);  // T is quadratic in both: any step is exact
    };
    const auto p = [&](double h) {
      return Eigen::Matrix<double, 1, 1>(slope(later(eq, m, h), &Motion::q_dot));
    };
    EXPECT_NEAR(inertia.q[k] - quadratic.q[k], difference(p, 1e-5)(0) - slope(m, &Motion::q),
                kTwiceDifferenced);
  }
}

TEST_P(DeformableInertia, weighs_by_the_gradient_of_its_energy) {
  const Equations eq = equations(GetParam());
  Motion m = some_motion(static_cast<int>(eq.n_s()));
  const Force h = gravity_force(eq, m, kGravity);
  const body::FrameMotion f = frame_motion(eq, m);
  const VectorXd velocity =
      eq.joint.type == JointType::free ? VectorXd((VectorXd(6) << f.v, f.w).finished()) : m.s_dot;
  const auto V = [&](double t) {
    return Eigen::Matrix<double, 1, 1>(gravity_energy(eq, later(eq, m, t), kGravity));
  };
  EXPECT_NEAR(velocity.dot(h.s) + m.q_dot.dot(h.q), -difference(V, 1e-5)(0), kTwiceDifferenced);
}

TEST_P(EquationsOfMotion, tangent_is_the_derivative_of_the_forces) {
  const Equations eq = equations(GetParam());
  const Motion m = some_motion(static_cast<int>(eq.n_s()));
  constexpr double kShiftV = 3, kShiftA = 20;
  const auto t = tangent(eq, m, kGravity, {kShiftV, kShiftA});
  const Eigen::MatrixXd U = border(eq);
  const auto forces = [&](const VectorXd& ds, const VectorXd& dq) {
    const Motion n{m.s + ds, m.s_dot + kShiftV * ds, m.s_ddot + kShiftA * ds,
                   m.q + dq, m.q_dot + kShiftV * dq, m.q_ddot + kShiftA * dq};
    const Force a = inertia_force(eq, n), b = quadratic_force(eq, n), c = gravity_force(eq, n, kGravity);
    VectorXd F(eq.n_s() + eq.n_q());
    F << a.s - b.s - c.s, a.q - b.q - c.q - kShiftA * (eq.body->M_r * dq);
    return F;
  };
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(eq.n_s() + eq.n_q(), eq.n_s() + eq.n_q()), D = J;
  J.topLeftCorner(eq.n_s(), eq.n_s()) = t.C;
  J.topRightCorner(eq.n_s(), eq.n_q()) = (U * t.rho).transpose();
  J.bottomLeftCorner(eq.n_q(), eq.n_s()) = U * t.beta;
  if (t.Q_s.rows() > 0) {
    J.topRightCorner(eq.n_s(), eq.n_q()) += t.R_q;
    J.bottomLeftCorner(eq.n_q(), eq.n_s()) += t.Q_s;
    for (Eigen::Index k = 0; k < eq.n_q(); ++k)
      J.col(eq.n_s() + k).tail(eq.n_q()) =
          body::contract(eq.body->inertia, t.Gamma, VectorXd::Unit(eq.n_q(), k));
  }
  const Eigen::MatrixXd Z = stiffness_in_border(eq, t.Gamma);
  if (Z.size() > 0) J.bottomRightCorner(eq.n_q(), eq.n_q()) += U * Z * U.transpose();
  for (Eigen::Index j = 0; j < J.cols(); ++j)
    D.col(j) = difference(
        [&](double h) {
          const VectorXd x = h * VectorXd::Unit(J.cols(), j);
          return forces(x.head(eq.n_s()), x.tail(eq.n_q()));
        },
        1e-5);
  EXPECT_LT((J - D).norm(), 1e-8 * J.norm());
}

std::vector<Case> cases(const std::vector<InertiaLevel>& levels) {
  std::vector<Case> all;
  for (InertiaLevel level : levels)
    for (JointType type : test::moving_joints()) all.push_back({type, level});
  return all;
}

std::string case_name(const testing::TestParamInfo<Case>& info) {
  const char* const levels[] = {"_constant", "_linear", "_affine", "_full"};
  return body::joint_names()[static_cast<std::size_t>(info.param.type)] +
         levels[static_cast<int>(info.param.level)];
}

using enum InertiaLevel;
INSTANTIATE_TEST_SUITE_P(JointsAndLevels, EquationsOfMotion,
                         testing::ValuesIn(cases({constant, linear, affine, full})), case_name);
INSTANTIATE_TEST_SUITE_P(JointsAndLevels, DeformableInertia, testing::ValuesIn(cases({linear, affine, full})),
                         case_name);

TEST(Equations, a_fixed_body_has_elastic_inertia_only) {
  const Equations eq = make_equations(test::random_body(), {}, InertiaLevel::linear);
  const Motion m = some_motion(0);
  EXPECT_LT((inertia_force(eq, m).q - eq.body->M_r * m.q_ddot).norm(), kRoundoff);
  EXPECT_EQ(quadratic_force(eq, m).q, VectorXd::Zero(test::kModes));
}

TEST(Equations, of_level_full_need_the_second_order_invariants) {
  auto body = std::make_shared<model::ElasticBody>(*test::random_body());
  body->inertia.S_2.clear();
  EXPECT_THROW(make_equations(body, {}, InertiaLevel::full), Error);
}

}  // namespace
}  // namespace elastogear::equations_test
