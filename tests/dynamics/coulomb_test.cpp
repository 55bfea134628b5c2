// Forces with Coulomb friction at unchanged closest points: the conditions that they must meet.
#include "dynamics/contact/coulomb.h"

#include <gtest/gtest.h>

#include <random>

namespace elastogear::coulomb_test {
using namespace dynamics;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

namespace {

// Contacts on a body whose flexibility couples all of them, some with friction.
struct Example {
  MatrixXd C;
  VectorXd q;
  std::vector<CoulombContact> contacts;
};

Example example(int n, double mu, double coupling, std::mt19937& random) {
  std::normal_distribution<double> normal;
  Example e;
  Index size = 0;
  for (int i = 0; i < n; ++i) {
    e.contacts.push_back({size, i % 4 != 3, mu});
    size += e.contacts.back().sticks ? 3 : 1;
  }
  const auto fill = [&](auto&& m) { m = m.unaryExpr([&](double) { return normal(random); }); };
  MatrixXd B = MatrixXd::Zero(size, size);
  fill(B);
  e.C = MatrixXd::Identity(size, size) + coupling / double(size) * B * B.transpose();
  e.C *= 1e-9;
  e.q = VectorXd::Zero(size);
  fill(e.q);
  e.q *= 1e-6;
  return e;
}

void expect_solved(const Example& e, const VectorXd& z) {
  constexpr double kRoundoff = 1e-9;
  const VectorXd y = e.q + e.C * z;
  const double length = kRoundoff * e.q.cwiseAbs().maxCoeff(), force = kRoundoff * z.cwiseAbs().maxCoeff();
  for (const CoulombContact& c : e.contacts) {
    const double p = z[c.first], gap = y[c.first];
    EXPECT_GE(p, 0);
    EXPECT_GE(gap, -length);
    if (p > 0) {
      EXPECT_LE(gap, length);
    }
    if (!c.sticks) continue;
    const Vector2d t = z.segment<2>(c.first + 1), u = y.segment<2>(c.first + 1);
    EXPECT_LE(t.norm(), c.mu * p + force);
    if (slides(c, z)) {
      EXPECT_LE((t.norm() * u + u.norm() * t).norm(), (length + kRoundoff * u.norm()) * (t.norm() + force));
    } else if (p > 0) {
      EXPECT_LE(u.norm(), length);
    }
  }
}

TEST(Coulomb, gaps_close_and_nodes_stick_or_slide_against_their_friction) {
  std::mt19937 random(5);
  int sliding = 0, sticking = 0;
  for (double mu : {0.0, 0.05, 0.3, 1.0})
    for (double coupling : {0.1, 3.0})
      for (int n : {1, 2, 5, 20, 60})
        for (int trial = 0; trial < 5; ++trial) {
          const Example e = example(n, mu, coupling, random);
          const auto z = solve_coulomb(e.C, e.q, e.contacts, VectorXd::Zero(e.q.size()));
          ASSERT_TRUE(z) << mu << " " << n;
          expect_solved(e, *z);
          for (const CoulombContact& c : e.contacts)
            if (c.sticks && (*z)[c.first] > 0) ++(slides(c, *z) ? sliding : sticking);
        }
  EXPECT_GT(sliding, 100);
  EXPECT_GT(sticking, 100);
}

TEST(Coulomb, of_no_contact_is_no_force) {
  EXPECT_EQ(solve_coulomb(MatrixXd(0, 0), VectorXd(0), {}, VectorXd(0))->size(), 0);
}

}  // namespace
}  // namespace elastogear::coulomb_test
