// The condensed system of many contacts against the dense matrix of docs/theory, Eq. (8.16).
#include "elastogear/dynamics/condensed_system.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numeric>

namespace elastogear::condensed_system_test {
using namespace dynamics;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kRoundoff = 1e-10;
constexpr Index kBodies = 2, kJoint = 2;  // joint coordinates of the first body; the second has none
constexpr int kNodes = 40;                // of each body
constexpr Index kRows = 3 * kNodes, kColumns = 4, kContacts = 30, kAll = kColumns * kContacts;

struct Case {
  EffectiveMatrix A;
  std::vector<CondensedBody> bodies;
};

// Compliances of a beam: neighbours move nearly alike, so that they are far from diagonal.
MatrixXd correlated(double reach) {
  MatrixXd G(kRows, kRows);
  for (Index i = 0; i < kRows; ++i)
    for (Index j = 0; j < kRows; ++j) G(i, j) = std::exp(-std::abs(static_cast<double>(i - j)) / reach);
  return G;
}

// Each contact has one stiff column and three with `weak` of its stiffness, between two nodes of each body.
Case many_contacts(double stiff, double weak, double reach = 10) {
  std::srand(5);
  Case c;
  c.A.n_contact = kAll;
  c.A.k.resize(kAll, kAll);
  for (Index j = 0; j < kAll; ++j)
    for (Index i = j - j % kColumns; i < j - j % kColumns + kColumns; ++i) {
      const bool leads = i == j && j % kColumns == 0, coupled = i % kColumns > 0 && j % kColumns > 0;
      if (leads) c.A.k.insert(i, j) = stiff;
      if (coupled) c.A.k.insert(i, j) = stiff * weak * VectorXd::Random(1)[0];
    }
  c.A.k.makeCompressed();
  for (Index b = 0; b < kBodies; ++b) {
    const Index n_s = b == 0 ? kJoint : 0;
    BodyTerms terms;
    terms.node.resize(kNodes);
    std::iota(terms.node.begin(), terms.node.end(), 0);
    terms.C = 50 * MatrixXd::Identity(n_s, n_s);
    terms.beta = 0.1 * MatrixXd::Random(kRows, n_s);
    terms.rho = 0.1 * MatrixXd::Random(kRows, n_s);
    terms.W_s = MatrixXd::Random(n_s, kAll);
    terms.V_s = MatrixXd::Random(n_s, kAll);
    MatrixXd L = MatrixXd::Zero(kRows, kAll);
    for (Index j = 0; j < kAll; ++j) L.col(j).segment<6>(3 * (j / kColumns)).setRandom();
    terms.L = L.sparseView();
    c.A.body.push_back(std::move(terms));
    c.bodies.push_back({0, n_s, std::make_shared<const MatrixXd>(correlated(reach))});
  }
  return c;
}

// Gives the columns of V other entries than those of W, and rates, which a residual displacement has not.
void take_potential(Case& c) {
  for (BodyTerms& terms : c.A.body) {
    terms.L_V = terms.L;
    terms.L_x = terms.L;
    for (double& value : terms.L_V.coeffs()) value *= 1.3;
    for (double& value : terms.L_x.coeffs()) value *= 0.9;
  }
}

void add_residual_flexibility(Case& c) { c.A.body[0].R = 0.5 * correlated(2); }

MatrixXd dense(const Case& c) {
  const EffectiveMatrix& A = c.A;
  MatrixXd small = MatrixXd::Identity(kJoint + kAll, kJoint + kAll);
  small.topLeftCorner(kJoint, kJoint).setZero();
  for (std::size_t b = 0; b < c.bodies.size(); ++b) {
    const BodyTerms& t = A.body[b];
    const Index n_s = c.bodies[b].n_s;
    const MatrixXd G = *c.bodies[b].G, R = t.R.size() > 0 ? t.R : MatrixXd::Zero(kRows, kRows), L = t.L,
                   L_V = t.L_V.size() > 0 ? MatrixXd(t.L_V) : L,
                   L_x = t.L_x.size() > 0 ? MatrixXd(t.L_x) : L_V,
                   V_G = L_V.transpose() * G + L_x.transpose() * R;
    small.topLeftCorner(n_s, n_s) += t.C - t.rho.transpose() * (G + R) * t.beta;
    small.topRightCorner(n_s, kAll) += (t.W_s - t.rho.transpose() * (G + R) * L) * A.k;
    small.bottomLeftCorner(kAll, n_s) += V_G * t.beta - t.V_s.transpose();
    small.bottomRightCorner(kAll, kAll) += V_G * L * A.k;
  }
  return small;
}

// Returns the steps of GMRES.
int expect_solved(const Case& c) {
  CondensedSystem system;
  system.set(c.A, c.bodies);
  const VectorXd right = VectorXd::Random(kJoint + kAll), x = dense(c).partialPivLu().solve(right);
  EXPECT_LT((system.solve(c.A, right) - x).norm(), kRoundoff * x.norm());
  return system.n_steps();
}

TEST(ManyContacts, are_solved_by_their_leading_columns_and_few_steps) {
  const Case c = many_contacts(100, 1e-4);
  CondensedSystem system;
  system.set(c.A, c.bodies);
  EXPECT_FALSE(system.is_whole());
  const int steps = expect_solved(c);
  EXPECT_GT(steps, 0);
  EXPECT_LT(steps, 15);
}

TEST(ManyContacts, that_are_stiff_against_their_bodies_keep_the_accuracy) {
  EXPECT_GT(expect_solved(many_contacts(1e6, 1e-8)), 0);
}

TEST(ManyContacts, need_no_leading_column_where_all_are_weak) {
  const Case c = many_contacts(1e-2, 0.5);
  CondensedSystem system;
  system.set(c.A, c.bodies);
  EXPECT_FALSE(system.is_whole());
  EXPECT_GT(expect_solved(c), 0);
}

TEST(ManyContacts, may_have_no_potential_and_residual_flexibility) {
  Case c = many_contacts(100, 1e-4);
  add_residual_flexibility(c);
  EXPECT_GT(expect_solved(c), 0);
  take_potential(c);
  EXPECT_GT(expect_solved(c), 0);
}

// The last columns are of markers, whose stiffness the compliance of the nodes does not tell.
TEST(ManyContacts, stand_beside_columns_of_markers) {
  Case c = many_contacts(100, 1e-4);
  c.A.n_contact = kAll - 2 * kColumns;
  c.A.k.coeffs().tail(10) *= 1e4;
  EXPECT_GT(expect_solved(c), 0);
}

TEST(ManyContacts, are_factorised_together_where_all_columns_lead) {
  Case c = many_contacts(100, 0.3);
  EXPECT_EQ(expect_solved(c), 0);
  CondensedSystem system;
  system.set(c.A, c.bodies);
  EXPECT_TRUE(system.is_whole());
}

// Each column is just below what leads, acts on all nodes, and pushes or pulls as it comes.
TEST(ManyContacts, are_factorised_together_where_steps_do_not_serve) {
  Case c = many_contacts(1, 0, 3);
  const MatrixXd signs = MatrixXd::Random(kAll, 1).cwiseSign();
  c.A.k = MatrixXd(0.09 * MatrixXd(signs.col(0).asDiagonal())).sparseView();
  for (BodyTerms& terms : c.A.body)
    terms.L = (std::sqrt(6.0 / kRows) * MatrixXd::Random(kRows, kAll)).sparseView();
  CondensedSystem system;
  system.set(c.A, c.bodies);
  EXPECT_FALSE(system.is_whole());
  EXPECT_EQ(expect_solved(c), 0);
}

}  // namespace
}  // namespace elastogear::condensed_system_test
