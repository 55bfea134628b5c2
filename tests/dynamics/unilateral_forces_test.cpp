// Forces of contacts without a penalty whose points of application move far as they change.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "dynamics/contact/unilateral_forces.h"

namespace elastogear::dynamics::unilateral_forces_test {
namespace {

using contact::ContactPoint;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kCompliance = 1e-9, kPenetrated = 1e-7;  // m/N, m
constexpr double kForce = 1000;                           // N
constexpr double kRoundoff = 1e-9;

// A contact between four nodes of the slave, from `first` on, and four of the master, whose force of 1 N
// passes between the nodes along A as these move: dF = F_p dp - gain A A' dx / R.
ContactPoint moving(int first, double gain, double gap, double p) {
  ContactPoint c;
  c.slave_nodes = Eigen::Vector4i::LinSpaced(first, first + 3);
  c.slave_N = Eigen::Vector4d(0.4, 0.3, 0.2, 0.1);
  c.master_nodes = Eigen::Vector4i::LinSpaced(0, 3);
  c.N = c.slave_N;
  c.p = p;
  c.c = 1e-4 * kCompliance;
  c.g_n = gap;
  c.F_p.setZero(3, 8);
  for (int i = 0; i < 4; ++i) c.F_p(2, i) = c.slave_N[i];
  c.g_x = c.F_p;
  c.F = p * c.F_p;
  c.W.setZero(24, 2);
  c.W.col(0) = c.F_p.reshaped();
  c.W.col(1).head<12>() = Eigen::Matrix<double, 12, 1>::LinSpaced(-1, 1).normalized();
  c.V_dot.setZero(24, 0);
  c.k = Eigen::Vector2d(1 / c.c, gain / kCompliance).asDiagonal();
  return c;
}

// The rows of a contact's vectors at the slave's nodes, among those of all of these.
MatrixXd at_nodes(const ContactPoint& c, const MatrixXd& columns, int n_rows) {
  MatrixXd all = MatrixXd::Zero(n_rows, columns.cols());
  all.middleRows(3 * c.slave_nodes[0], 12) = columns.topRows(12);
  return all;
}

// A body of symmetric compliance (m/N): each node gives way on its own, but for a tenth.
MatrixXd compliance(int n) {
  return kCompliance * (0.9 * MatrixXd::Identity(n, n) + MatrixXd::Constant(n, n, 0.1 / n));
}

// Contacts along a row of nodes, every third one open, each with a gain of its own up to `most`.
std::vector<ContactPoint> row(int n, double most) {
  std::vector<ContactPoint> contacts;
  for (int i = 0; i < n; ++i)
    contacts.push_back(i % 3 == 2 ? moving(3 * i, 0, 5 * kPenetrated, 0)
                                  : moving(3 * i, most * (i + 1) / n, -kPenetrated * (i % 2), kForce));
  return contacts;
}

// With 40 contacts of high gain substitution does not come to rest in any order.
TEST(UnilateralForces, close_gaps_while_they_pass_from_node_to_node) {
  for (int n : {3, 40})
    for (double gain : {0.0, 0.3, 3.0, 30.0}) {
      const std::vector<ContactPoint> found = row(n, gain);
      const int rows = 3 * (3 * n + 1);
      std::vector<PairContacts> pairs{{{0, 1}, found}};
      const MatrixXd R = compliance(rows);
      const Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();
      std::vector<int> nodes(static_cast<std::size_t>(rows / 3));
      std::iota(nodes.begin(), nodes.end(), 0);
      const VectorXd missing = VectorXd::LinSpaced(rows, -0.3 * kPenetrated, 0.3 * kPenetrated);
      UnilateralForces forces(pairs);
      forces.add({0, R_WB, nodes, R}, missing);
      ASSERT_TRUE(forces.solve()) << gain;
      EXPECT_TRUE(forces.takes_turning_in()) << gain;
      forces.set_forces(pairs);
      const VectorXd dx = missing + R * forces.force_change(0);
      VectorXd change = VectorXd::Zero(rows), by_point = change;
      for (std::size_t i = 0; i < found.size(); ++i) {
        const ContactPoint &before = found[i], &after = pairs[0].points[i];
        const MatrixXd W = at_nodes(before, before.W, rows);
        const double closed = before.g_n + W.col(0).dot(dx) + before.c * after.p;
        change += W.col(0) * (after.p - before.p) - W.col(1) * before.k(1, 1) * W.col(1).dot(dx);
        by_point += at_nodes(before, (after.F - before.F).reshaped(), rows);
        EXPECT_EQ(after.p > 0, before.p > 0) << gain << " " << i;
        EXPECT_GE(closed, -kRoundoff * kPenetrated) << gain;
        EXPECT_LE(std::min(after.p * kCompliance, closed), kRoundoff * kPenetrated) << gain << " " << i;
      }
      EXPECT_LT((forces.force_change(0) - change).norm(), kRoundoff * kForce) << gain;
      EXPECT_LT((by_point - change).norm(), kRoundoff * kForce) << gain;
    }
}

}  // namespace
}  // namespace elastogear::dynamics::unilateral_forces_test
