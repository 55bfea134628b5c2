// Internal variables of viscoelastic bodies against the solution of their equations, z' = (q - z)/tau.

#include "elastogear/body/relaxation.h"

#include <gtest/gtest.h>

#include <cmath>

namespace elastogear::relaxation_law_test {
using namespace body;

namespace {

constexpr double kRoundoff = 1e-13;

// Two parts of a body with two coordinates, which share one of their times.
model::ElasticBody two_parts() {
  model::ElasticBody body;
  Eigen::Matrix2d K_1, K_2;
  K_1 << 3, 1, 1, 2;
  K_2 << 1, -0.5, -0.5, 4;
  body.K_r = Eigen::Matrix2d(1.5 * (K_1 + K_2)).sparseView();
  body.relaxing = {
      {"a", model::ModulusPart::shear, Eigen::Vector2d(0.3, 0.2), Eigen::Vector2d(1, 0.1), K_1.sparseView()},
      {"b", model::ModulusPart::both, Eigen::Vector2d(0.4, 0.1), Eigen::Vector2d(0.1, 1e4),
       K_2.sparseView()}};
  return body;
}

// z(h) of z' = (q - z)/tau for q = a + b t.
double followed(double z_0, double a, double b, double tau, double h) {
  return a + b * (h - tau) + (z_0 - a + b * tau) * std::exp(-h / tau);
}

TEST(RelaxationLaw, gathers_the_times_of_all_parts) {
  const RelaxationLaw law = relaxation_law(two_parts());
  EXPECT_EQ(law.tau, Eigen::Vector3d(0.1, 1, 1e4));
  Eigen::Matrix<double, 2, 3> g;
  g << 0.2, 0.3, 0, 0.4, 0, 0.1;
  EXPECT_EQ(law.g, g);
}

TEST(RelaxationLaw, internal_variables_are_exact_for_linear_motion) {
  const RelaxationLaw law = relaxation_law(two_parts());
  InternalState start{0, Eigen::Vector2d(0.5, -1), Eigen::MatrixXd(2, 3)};
  start.z << 0.1, 0.2, 0.3, -0.4, 0.5, 0;
  const Eigen::Vector2d rate(2, -3);
  for (double h : {1e-3, 0.5, 100.0}) {
    const Eigen::MatrixXd z = internal_variables(law, start, {h, 1}, start.q + h * rate);
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 2; ++k) {
        const double exact = followed(start.z(k, i), start.q[k], rate[k], law.tau[i], h);
        EXPECT_NEAR(z(k, i), exact, kRoundoff * std::max({1.0, 10 * h, law.tau[i]})) << h << " " << i;
      }
  }
}

TEST(RelaxationLaw, stage_is_the_weighted_mean_of_both_ends) {
  const RelaxationLaw law = relaxation_law(two_parts());
  InternalState start{0, Eigen::Vector2d(0.5, -1), Eigen::MatrixXd::Constant(2, 3, 0.2)};
  const Eigen::Vector2d end(0.7, 2);
  for (double alpha : {0.5, 0.6, 1.0}) {
    const Eigen::MatrixXd z_1 = internal_variables(law, start, {0.3, 1}, end);
    const Eigen::MatrixXd z =
        internal_variables(law, start, {0.3, alpha}, (1 - alpha) * start.q + alpha * end);
    EXPECT_LT((z - (1 - alpha) * start.z - alpha * z_1).norm(), kRoundoff);
  }
}

// From a step of 1e-12 of the time to one of 1e12.
TEST(RelaxationLaw, share_that_follows_is_right_over_24_decades) {
  for (double h = 1e-12; h < 1e12; h *= 1.7) {
    const long double x = h, exact = h < 1e-4 ? x / 2 - x * x / 6 + x * x * x / 24 : 1 + std::expm1(-x) / x;
    EXPECT_NEAR(following_shares({Eigen::VectorXd::Ones(1), {}}, h)[0] / static_cast<double>(exact), 1, 1e-12)
        << h;
  }
}

// The work of the force at the middle of a step, less what is stored, is what the dashpots take.
TEST(RelaxationLaw, energy_of_a_step_of_the_midpoint_rule_closes) {
  const model::ElasticBody body = two_parts();
  const RelaxationLaw law = relaxation_law(body);
  InternalState from{0, Eigen::Vector2d(0.5, -1), Eigen::MatrixXd::Random(2, 3)};
  InternalState to{0.2, Eigen::Vector2d(0.8, 0.1), {}};
  to.z = internal_variables(law, from, {0.2, 1}, to.q);
  const Eigen::Vector2d middle = (from.q + to.q) / 2;
  const Eigen::MatrixXd z = internal_variables(law, from, {0.2, 0.5}, middle);
  const Eigen::Vector2d force = body.K_r * middle - relaxed_force(body, z * law.g.transpose());
  const auto stored = [&](const InternalState& x) {
    return 0.5 * x.q.dot(body.K_r * x.q) + relaxed_energy(body, law, x.q, x.z);
  };
  const double loss = relaxation_loss(body, law, from, to);
  EXPECT_NEAR(force.dot(to.q - from.q), stored(to) - stored(from) + loss, 10 * kRoundoff);
  EXPECT_GT(std::abs(loss), 0.01);
}

// Held after all has relaxed: what is stored is that of the long-term stiffness.
TEST(RelaxationLaw, relaxed_body_stores_the_energy_of_its_long_term_stiffness) {
  const model::ElasticBody body = two_parts();
  const RelaxationLaw law = relaxation_law(body);
  const Eigen::Vector2d q(0.5, -1);
  const Eigen::MatrixXd z = q.replicate(1, 3);
  const Eigen::Matrix2d K = Eigen::Matrix2d(body.K_r) - 0.5 * Eigen::Matrix2d(body.relaxing[0].K) -
                            0.5 * Eigen::Matrix2d(body.relaxing[1].K);
  EXPECT_NEAR(0.5 * q.dot(body.K_r * q) + relaxed_energy(body, law, q, z), 0.5 * q.dot(K * q), kRoundoff);
  EXPECT_LT((body.K_r * q - relaxed_force(body, z * law.g.transpose()) - K * q).norm(), kRoundoff);
}

}  // namespace
}  // namespace elastogear::relaxation_law_test
