// Contact forces with damping, friction and heights over the face: balance, objectivity, power, tangent.
#include "contact/forces/law.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <functional>
#include <optional>

#include "contact/forces/contact_point.h"
#include "surfaces.h"

namespace elastogear::contact::law_test {
namespace {

using Eigen::Vector3d;
using test::Random;
using Vector15 = Eigen::Matrix<double, 15, 1>;
using Matrix15 = Eigen::Matrix<double, 15, 15>;

constexpr double roundoff = 1e-11;
constexpr double c_p = 3;

// One slave node behind a face of size 2, penetrating by `depth`.
struct Local {
  Face face;
  Vector3d q;
  Eigen::Matrix<double, 3, 5> v;
  Heights heights{{FaceHeights{}}};
};

Local behind(Random& random, int sides, double depth) {
  Local local;
  local.face.sides = sides;
  const double x[4] = {-1, 1, 1, -1}, y[4] = {-1, -1, 1, 1};
  const Eigen::Matrix3d R = test::rotation(random.vector(3));
  for (int i = 0; i < 4; ++i) local.face.x[i] = R * (Vector3d(x[i], 0.8 * y[i], 0) + random.vector(0.2));
  if (sides == 3) local.face.x[3] = local.face.x[2];
  const double u = sides == 3 ? 0.3 : random.uniform(-0.8, 0.8),
               w = sides == 3 ? 0.2 : random.uniform(-0.8, 0.8);
  local.q = combine(local.face, shape(sides, u, w).N) - depth * normal(local.face, u, w);
  for (auto v : local.v.colwise()) v = random.vector(1);
  return local;
}

// In front of side 0, so that the closest point lies on it.
Local at_edge(Random& random, double depth) {
  Local local = behind(random, 4, depth);
  const Vector3d a = local.face.x[0], b = local.face.x[1], n = normal(local.face, 0, 0);
  local.q = 0.6 * a + 0.4 * b - depth * (0.8 * n - 0.6 * (b - a).cross(n).normalized());
  return local;
}

// Over the extended side 1, where part of the force is left.
Local beyond_end(Random& random, int sides, double depth) {
  Local local = behind(random, sides, 0);
  const double extension = 0.2, beyond = random.uniform(0.2, 0.8) * extension;
  local.face.extension[1] = extension;
  const double u = sides == 3 ? 0.7 + beyond : 1 + 2 * beyond,
               w = sides == 3 ? 0.3 : random.uniform(-0.8, 0.8);
  local.q = combine(local.face, shape(sides, u, w).N) - depth * normal(local.face, u, w);
  return local;
}

Projection projection(const Local& local) {
  Projection w{0, closest_point(local.face, local.q), {}, 0};
  const Vector3d d = local.q - w.point.x;
  if (w.point.feature == Feature::face) {
    w.n = normal(local.face, w.point.u, w.point.v);
    w.g_n = w.n.dot(d);
  } else {
    w.g_n = -d.norm();
    w.n = d / w.g_n;
  }
  return w;
}

FaceFunction height_at(const Local& local, const Projection& w) {
  const FaceFunction full = height(local.heights, local.face.sides, 0, w.point.u, w.point.v);
  return w.point.feature == Feature::face ? full : FaceFunction{};
}

FaceFunction fade_at(const Local& local, const Projection& w) {
  return w.point.feature == Feature::face ? fade_factor(local.face, w.point.u, w.point.v) : FaceFunction{1};
}

struct Outcome {
  ContactPoint contact;
  Projection w;
  ProjectionKinematics kinematics;
};

// anchor: where the node stuck, local coordinates.
Outcome force(const Local& local, const Law& law, const Eigen::Vector2d* anchor = nullptr) {
  Outcome o;
  o.w = projection(local);
  o.kinematics = projection_kinematics(local.face, o.w, local.q);
  o.contact.v = local.v;
  o.contact.N = o.w.point.N;
  StickMotion stick;
  if (anchor) {
    const Eigen::Vector4d N = shape(local.face.sides, (*anchor)[0], (*anchor)[1]).N;
    stick.u = o.w.point.x - combine(local.face, N);
    stick.u_x = o.kinematics.a * o.kinematics.D + spread(0, o.w.point.N - N);
  }
  const Gap open = gap(o.kinematics, height_at(local, o.w), law.offset, fade_at(local, o.w));
  apply_law(law, o.kinematics, open, anchor ? &stick : nullptr, o.contact);
  return o;
}

Local moved(Local local, const Vector15& dx, const Vector15& dv) {
  local.q += dx.head<3>();
  for (int i = 0; i < 4; ++i) local.face.x[i] += dx.segment<3>(3 + 3 * i);
  local.v += dv.reshaped(3, 5);
  return local;
}

using ForceOf = std::function<Outcome(const Local&)>;

struct Quotients {
  Matrix15 by_x, by_v;
};

Quotients difference_quotients(const Local& local, const ForceOf& force_of) {
  const double h = 1e-7;
  Quotients K;
  for (int j = 0; j < 15; ++j) {
    const Vector15 e = h * Vector15::Unit(j), zero = Vector15::Zero();
    const auto F = [&](const Vector15& dx, const Vector15& dv) {
      return Vector15(force_of(moved(local, dx, dv)).contact.F.reshaped());
    };
    K.by_x.col(j) = (F(e, zero) - F(-e, zero)) / (2 * h);
    K.by_v.col(j) = (F(zero, e) - F(zero, -e)) / (2 * h);
  }
  return K;
}

struct Errors {
  double by_x, by_v;  // of the tangent, relative
};

Errors tangent_errors(const Local& local, const ForceOf& force_of) {
  const ContactPoint c = force_of(local).contact;
  const Quotients K = difference_quotients(local, force_of);
  const Matrix15 K_x = -c.W * c.k * c.displacement_columns().transpose(),
                 K_v = -c.W * c.k * c.V_dot.transpose();
  return {(K_x - K.by_x).norm() / K.by_x.norm(), (K_v - K.by_v).norm() / std::max(K.by_v.norm(), 1e-9)};
}

constexpr double truncation = 3e-6;  // of the difference quotients
constexpr double thin = 1e-4;        // penetration over face size: its square is below the truncation

// With a dashpot as strong as the penalty at the given depth.
Law law_with(double friction, double depth) {
  Law law;
  law.c_p = c_p;
  law.d_p = 0.5 * c_p * depth;
  law.hysteresis = 0.4;
  law.mu = law.mu_static = friction;
  law.v_0 = 0.7;
  return law;
}

enum class Where { quadrilateral, triangle, edge, end, end_of_triangle };

Local place(Random& random, Where where, double depth) {
  const bool beyond = where == Where::end || where == Where::end_of_triangle,
             triangle = where == Where::triangle || where == Where::end_of_triangle;
  Local local = beyond                 ? beyond_end(random, triangle ? 3 : 4, depth)
                : where == Where::edge ? at_edge(random, depth)
                                       : behind(random, triangle ? 3 : 4, depth);
  for (double& h : local.heights.face[0].C.reshaped()) h = 0.01 * random.uniform(-depth, depth);
  return local;
}

class ContactLaw : public testing::TestWithParam<Where> {};

TEST_P(ContactLaw, tangent_with_damping_and_friction_equals_the_difference_quotient) {
  Random random(1);
  for (int trial = 0; trial < 20; ++trial) {
    const Local local = place(random, GetParam(), 2 * thin);
    const Errors e = tangent_errors(local, [](const Local& x) { return force(x, law_with(0.5, thin)); });
    EXPECT_LT(e.by_x, truncation);
    EXPECT_LT(e.by_v, truncation);
  }
}

TEST_P(ContactLaw, tangent_of_a_sticking_and_a_slipping_spring_equals_the_difference_quotient) {
  Random random(2);
  for (double mu : {1e3, 0.1})
    for (int trial = 0; trial < 20; ++trial) {
      const Local local = place(random, GetParam(), 2 * thin);
      Law law = law_with(mu, thin);
      law.v_0 = 0;
      law.c_t = c_p;
      const Projection w = projection(local);
      const Eigen::Vector2d anchor(w.point.u + 1e-3, w.point.v - 2e-3);
      const Errors e = tangent_errors(local, [&](const Local& x) { return force(x, law, &anchor); });
      EXPECT_LT(e.by_x, truncation) << mu;
    }
}

TEST_P(ContactLaw, tangent_with_damping_alone_is_exact_at_any_depth) {
  Random random(8);
  for (int trial = 0; trial < 20; ++trial) {
    Local local = place(random, GetParam(), 0.2);
    local.heights = Local{}.heights;  // with them the force has a tangential part
    const Errors e = tangent_errors(local, [](const Local& x) { return force(x, law_with(0, 0.2)); });
    EXPECT_LT(e.by_x, truncation);
    EXPECT_LT(e.by_v, truncation);
  }
}

// With the force of a closed gap, beside a penalty that is stiffened.
Law augmented(double stiffened, double p_given) {
  Law law;
  law.c_p = stiffened * c_p;
  law.stiffened = stiffened;
  law.p_given = p_given;
  return law;
}

TEST_P(ContactLaw, tangent_of_an_augmented_force_equals_the_difference_quotient) {
  Random random(9);
  for (double stiffened : {1., 16.})
    for (int trial = 0; trial < 20; ++trial) {
      const Local local = place(random, GetParam(), 2 * thin);
      const Law law = augmented(stiffened, 0.5 * c_p * thin);
      EXPECT_LT(tangent_errors(local, [&](const Local& x) { return force(x, law); }).by_x, truncation);
    }
}

// In a step that ends with a rate that is too low.
Law in_impact(double friction) {
  Law law = law_with(friction, 0);
  law.hysteresis = 0;
  law.impact =
      Impact{.in_step = true, .may_close = true, .closed = true, .d = 200, .stiffened = 40, .alpha_f = 0.6};
  law.impact->p_held = 20;
  law.impact->rate = 0.3;
  law.impact->least_rate = 5;
  return law;
}

TEST_P(ContactLaw, tangent_of_an_impact_equals_the_difference_quotient) {
  Random random(11);
  for (double friction : {0., 0.4})
    for (int trial = 0; trial < 20; ++trial) {
      const Local local = place(random, GetParam(), 2 * thin);
      const Errors e = tangent_errors(local, [&](const Local& x) { return force(x, in_impact(friction)); });
      EXPECT_LT(e.by_x, friction > 0 ? thin : truncation);
      EXPECT_LT(e.by_v, truncation);
    }
}

TEST_P(ContactLaw, impact_holds_the_rate_at_the_end_of_the_step) {
  Random random(12);
  for (int trial = 0; trial < 20; ++trial) {
    const Local local = place(random, GetParam(), 2 * thin);
    const ContactPoint c = force(local, in_impact(0)).contact;
    const double rate = c.g_x.reshaped().dot(local.v.reshaped()), end = (rate - 0.4 * 0.3) / 0.6;
    EXPECT_NEAR(c.excess_rate, end - 5, roundoff);
    EXPECT_LE(c.p, (20 + 200 * (5 - end)) * (1 + roundoff));
    EXPECT_GT(c.p, 0);
  }
}

// Where g + (1 / w - 1) p / c_p = 0 the force is the one that was given, however stiff the penalty is now.
TEST_P(ContactLaw, augmented_force_of_a_closed_gap_is_the_one_given) {
  Random random(10);
  for (int trial = 0; trial < 20; ++trial) {
    const Local local = place(random, GetParam(), 2 * thin);
    const Outcome soft = force(local, augmented(1, 0));  // p = -w c_p g
    for (double stiffened : {1., 4., 64.}) {
      const double p = soft.contact.p, g = soft.contact.g_n, w = -p / (c_p * g);
      if (w > 0.999) continue;
      const double closed = -g / (1 / w - 1) * c_p;
      EXPECT_NEAR(force(local, augmented(stiffened, closed)).contact.p, closed, 1e-9 * closed);
    }
  }
}

// What the tangent of friction leaves out is of the order of (penetration / face size)^2.
TEST(ContactForce, error_of_the_tangent_falls_with_the_square_of_the_penetration) {
  Random random(3);
  double last = 0;
  for (double depth : {0.2, 0.1, 0.05}) {
    Random same(4);
    double sum = 0;
    for (int trial = 0; trial < 20; ++trial)
      sum += tangent_errors(behind(same, 4, depth), [=](const Local& x) {
               return force(x, law_with(0.5, depth));
             }).by_x;
    if (last > 0) {
      EXPECT_LT(sum, last / 3);
    }
    last = sum;
  }
  EXPECT_GT(last, 20 * truncation) << "deep enough to see it";
}

TEST_P(ContactLaw, forces_and_moments_balance_and_rigid_motion_has_no_rate) {
  Random random(5);
  for (int trial = 0; trial < 20; ++trial) {
    Local local = place(random, GetParam(), 0.2);
    const auto moment = [&](const LocalVectors& F) {
      Vector3d sum = local.q.cross(F.col(0));
      for (int i = 0; i < 4; ++i) sum += local.face.x[i].cross(F.col(1 + i));
      return sum;
    };
    const ContactPoint c = force(local, law_with(0.5, 0.1)).contact;
    EXPECT_GT(c.f.norm(), 0.1);
    EXPECT_LT(c.F.rowwise().sum().norm(), roundoff);
    EXPECT_LT(moment(c.F).norm(), roundoff);
    const Vector3d omega = random.vector(2), v = random.vector(2);
    local.v.col(0) = v + omega.cross(local.q);
    for (int i = 0; i < 4; ++i) local.v.col(1 + i) = v + omega.cross(local.face.x[i]);
    const ContactPoint still = force(local, law_with(0.5, 0.1)).contact;
    EXPECT_LT(still.slip.norm(), roundoff);
    EXPECT_NEAR(still.power, 0, roundoff);
  }
}

// What the local forces take from the nodes' motion goes into the gap's energy, damping and friction.
TEST_P(ContactLaw, power_of_the_forces_is_stored_or_dissipated) {
  Random random(6);
  for (int trial = 0; trial < 20; ++trial) {
    const Local local = place(random, GetParam(), 0.1);
    const Law law = law_with(0.5, 0.1);
    const double h = 1e-6;
    const Vector15 v = local.v.reshaped(), zero = Vector15::Zero();
    const auto energy = [&](double t) { return force(moved(local, t * v, zero), law).contact.energy; };
    const ContactPoint c = force(local, law).contact;
    const double taken = -c.F.reshaped().dot(v), stored = (energy(h) - energy(-h)) / (2 * h);
    EXPECT_NEAR(taken, stored + c.power + c.friction_power, 1e-7);
    EXPECT_GE(c.power, 0);
    EXPECT_GE(c.friction_power, 0);
  }
}

// Without a penalty the force p is given: that at which g + c p = 0, or the stated one.
Outcome unilateral(const Local& local, double friction, std::optional<double> p = {}) {
  Law law = law_with(friction, 0);
  law.hysteresis = 0;
  law.unilateral = true;
  law.compliance = 1e-4;
  Outcome o;
  o.w = projection(local);
  o.kinematics = projection_kinematics(local.face, o.w, local.q);
  o.contact.v = local.v;
  o.contact.N = o.w.point.N;
  const Gap open = gap(o.kinematics, height_at(local, o.w), 0, fade_at(local, o.w));
  law.p_given = p.value_or(-open.g / unilateral_compliance(law, open.fade.f));
  apply_law(law, o.kinematics, open, nullptr, o.contact);
  return o;
}

TEST_P(ContactLaw, without_penalty_has_the_tangent_of_a_force_that_keeps_the_gap_closed) {
  Random random(11);
  for (int trial = 0; trial < 20; ++trial) {
    const Local local = place(random, GetParam(), 2 * thin);
    const Errors e = tangent_errors(local, [](const Local& x) { return unilateral(x, 0.3); });
    EXPECT_LT(e.by_x, truncation);
    EXPECT_LT(e.by_v, truncation);
  }
}

TEST_P(ContactLaw, without_penalty_states_how_force_and_gap_change_with_p) {
  Random random(12);
  const double h = 1e-6;
  for (int trial = 0; trial < 20; ++trial) {
    const Local local = place(random, GetParam(), 100 * thin);
    const ContactPoint c = unilateral(local, 0.3, 2).contact;
    const LocalVectors F_p =
        (unilateral(local, 0.3, 2 + h).contact.F - unilateral(local, 0.3, 2 - h).contact.F) / (2 * h);
    EXPECT_LT((c.F_p - F_p).norm(), 1e-8 * F_p.norm());
    for (int j = 0; j < 15; ++j) {
      const auto sum = [&](double step) {
        const ContactPoint moved_c =
            unilateral(moved(local, step * Vector15::Unit(j), Vector15::Zero()), 0.3, 2).contact;
        return moved_c.g_n + moved_c.c * moved_c.p;
      };
      EXPECT_NEAR(c.g_x.reshaped()[j], (sum(h) - sum(-h)) / (2 * h), 1e-6 * (1 + c.g_x.norm()));
    }
  }
}

constexpr auto kFeatures = {Where::quadrilateral, Where::triangle, Where::edge};
INSTANTIATE_TEST_SUITE_P(Features, ContactLaw, testing::ValuesIn(kFeatures));
INSTANTIATE_TEST_SUITE_P(Ends, ContactLaw, testing::Values(Where::end, Where::end_of_triangle));

TEST(ContactForce, damping_acts_on_approach_alone_and_never_pulls) {
  Law law = law_with(0, 0.1);
  for (double gap : {-1e-3, -1e-9})
    for (double rate : {-100.0, -1.0, 0.0, 1.0, 1e6}) {
      const NormalForce f = normal_force(law, gap, rate);
      EXPECT_GE(f.p, 0);
      EXPECT_EQ(rate<0, f.p> - law.c_p * gap);
    }
  EXPECT_EQ(normal_force(law, 0, -1).p, 0);
  EXPECT_EQ(normal_force(law, 1e-9, -1).p, 0);
}

TEST(ContactForce, friction_is_at_most_mu_times_the_normal_force_and_against_the_slip) {
  Random random(7);
  for (int trial = 0; trial < 50; ++trial) {
    Local local = behind(random, 4, 0.1);
    local.v *= std::pow(10.0, random.uniform(-4, 4));
    const ContactPoint c = force(local, law_with(0.3, 0.1)).contact;
    const double p = c.f.dot(c.n);
    const Vector3d f_t = c.f - p * c.n;
    EXPECT_LE(f_t.norm(), 0.3 * p * (1 + roundoff));
    EXPECT_LT(f_t.cross(c.slip).norm(), roundoff * (1 + c.slip.norm()));
    EXPECT_LE(f_t.dot(c.slip), 0);
  }
}

}  // namespace
}  // namespace elastogear::contact::law_test
