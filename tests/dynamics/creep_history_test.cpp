// The history of forces that wander over many nodes, beside the states of all nodes summed up one by one.

#include "dynamics/creep/creep_history.h"

#include <gtest/gtest.h>

#include <cmath>

namespace elastogear::creep_history_test {
using namespace dynamics;
using body::CreepState;
using Eigen::Index, Eigen::Matrix3Xd, Eigen::MatrixXd, Eigen::Vector3d, Eigen::VectorXd;

namespace {

constexpr int kNodes = 60;       // around a ring
constexpr int kStepsANode = 10;  // while the force goes on by a node
constexpr int kTurn = kNodes * kStepsANode;
constexpr double kRoundoff = 1e-10;

body::RelaxationLaw law(const Eigen::Vector3d& g) { return {Vector3d(0.5, 50, 1e9), g.transpose()}; }

double step_length(int step) { return step % 7 == 0 ? 0.3 : 0.1; }

// Displacements of each node by unit forces on each other one, which fall with the distance: by each law a
// multiple of a matrix that is symmetric and positive definite.
class Ring {
 public:
  explicit Ring(std::vector<body::RelaxationLaw> laws, VectorXd share)
      : laws_(std::move(laws)), share_(std::move(share)), D_(3 * kNodes, 3 * kNodes) {
    for (int a = 0; a < kNodes; ++a)
      for (int b = 0; b < kNodes; ++b) {
        const int apart = std::abs(a - b), distance = std::min(apart, kNodes - apart);
        const Eigen::Matrix3d coupling = 0.2 * Eigen::Matrix3d::Ones() + Eigen::Matrix3d::Identity();
        D_.block<3, 3>(3 * a, 3 * b) = std::exp(-0.3 * distance) * coupling;
      }
  }

  const std::vector<body::RelaxationLaw>& laws() const { return laws_; }
  Index n_laws() const { return share_.size(); }
  Eigen::Matrix3d D(int a, int b) const { return D_.block<3, 3>(3 * a, 3 * b); }

  CreepState displaced_by(int a, int b, const CreepState& force) const {
    const Index n = force.cols() / n_laws();
    CreepState displaced = D(a, b) * force;
    for (Index j = 0; j < n_laws(); ++j) displaced.middleCols(j * n, n) *= share_[j];
    return displaced;
  }
  Matrix3Xd displaced(int a, const NodalForces& forces) const {
    Vector3d sum = Vector3d::Zero();
    for (std::size_t i = 0; i < forces.node.size(); ++i)
      sum += D(a, forces.node[i]) * forces.f_B.col(static_cast<Index>(i));
    return sum * share_.transpose();
  }
  CreepHistory::Response response(const NodalForces& forces) const {
    return {[this](int a, int b, const CreepState& force) { return displaced_by(a, b, force); },
            [this, &forces](int a) { return displaced(a, forces); }};
  }

 private:
  std::vector<body::RelaxationLaw> laws_;
  VectorXd share_;
  MatrixXd D_;
};

// Forces on three nodes, the first of which the load is about to leave.
NodalForces load(int step) {
  const int first = step / kStepsANode;
  const double way = (step % kStepsANode) / double(kStepsANode);
  std::map<int, Vector3d> force;
  const Vector3d f(100, -20, 300 + 50 * std::sin(0.1 * step));
  force[first % kNodes] = (1 - way) * f;
  force[(first + 1) % kNodes] = f;
  force[(first + 2) % kNodes] = way * f;
  NodalForces forces;
  forces.f_B.resize(3, 3);
  for (const auto& [node, value] : force) {
    forces.f_B.col(static_cast<Index>(forces.node.size())) = value;
    forces.node.push_back(node);
  }
  return forces;
}

// The states of all nodes, one by one.
class OneByOne {
 public:
  explicit OneByOne(const Ring& ring)
      : ring_(ring), laws_(ring.laws()), state_(kNodes, CreepState::Zero(3, laws_.n_columns())) {}

  void step(double dt, const NodalForces& forces) {
    laws_.set_point(body::Moduli::relaxing, {dt, 1});
    const std::vector<CreepState> before = state_, field_before = fields();
    for (int a = 0; a < kNodes; ++a) {
      const auto at = std::find(forces.node.begin(), forces.node.end(), a);
      const Vector3d f = at == forces.node.end() ? Vector3d(Vector3d::Zero())
                                                 : Vector3d(forces.f_B.col(at - forces.node.begin()));
      state_[a] = laws_.state(before[a], f);
    }
    const std::vector<CreepState> field = fields();
    for (int a = 0; a < kNodes; ++a) loss += laws_.loss({before[a], state_[a]}, {field_before[a], field[a]});
    laws_.set_point(body::Moduli::relaxing, {0, 1});
  }
  Vector3d lag(int a) const { return laws_.lag(field(a)); }
  double twice_energy() const {
    double sum = 0;
    for (int a = 0; a < kNodes; ++a) sum += laws_.twice_energy(state_[a], field(a));
    return sum;
  }
  const CreepState& state(int a) const { return state_[a]; }

  double loss = 0;

 private:
  CreepState field(int a) const {
    CreepState sum = CreepState::Zero(3, laws_.n_columns());
    for (int b = 0; b < kNodes; ++b) sum += ring_.displaced_by(a, b, state_[b]);
    return sum;
  }
  std::vector<CreepState> fields() const {
    std::vector<CreepState> all;
    for (int a = 0; a < kNodes; ++a) all.push_back(field(a));
    return all;
  }

  const Ring& ring_;
  body::CreepLaws laws_;
  std::vector<CreepState> state_;
};

// One step of the history; contact asks for the nodes around the load.
CreepHistory::Lag step(CreepHistory& history, const Ring& ring, int number) {
  const NodalForces forces = load(number);
  const CreepHistory::Response response = ring.response(forces);
  const CreepHistory::Lag lag = history.set_point(body::Moduli::relaxing, {step_length(number), 1}, response);
  for (int i = -2; i < 6; ++i) history.lag((number / kStepsANode + kNodes + i) % kNodes, response);
  history.accept(forces, response);
  history.set_point(body::Moduli::relaxing, {0, 1}, response);
  history.gather(response);
  return lag;
}

Ring two_laws() { return Ring({law({0.2, 0.2, 0.1}), law({0.05, 0.1, 0.05})}, Eigen::Vector2d(1.5, -0.5)); }

TEST(CreepHistory, of_forces_that_wander_is_the_sum_over_all_nodes) {
  const Ring ring = two_laws();
  CreepHistory history(ring.laws(), kNodes);
  OneByOne all(ring);
  double worst_lag = 0, worst_energy = 0, worst_loss = 0;
  std::size_t most_recent = 0;
  for (int number = 0; number < 2 * kTurn + 5; ++number) {
    step(history, ring, number);
    all.step(step_length(number), load(number));
    most_recent = std::max(most_recent, history.n_recent());
    if (number % 37 != 5) continue;
    const NodalForces forces = load(number);
    const CreepHistory::Response response = ring.response(forces);
    for (int a = 0; a < kNodes; a += number % 5 + 1)
      worst_lag = std::max(worst_lag,
                           (history.lag(a, response) - all.lag(a)).norm() / all.lag(forces.node[1]).norm());
    worst_energy =
        std::max(worst_energy, std::abs(history.twice_energy(forces, response) / all.twice_energy() - 1));
    worst_loss = std::max(worst_loss, std::abs(history.loss() / all.loss - 1));
  }
  EXPECT_LT(worst_lag, kRoundoff);
  EXPECT_LT(worst_energy, kRoundoff);
  EXPECT_LT(worst_loss, kRoundoff);
  EXPECT_LE(most_recent, 12u);  // of 60 that remember
  model::RelaxedState state;
  history.get(state);
  ASSERT_EQ(state.node.size(), std::size_t(kNodes));
  const Index n = history.laws().n_columns();
  for (int a = 0; a < kNodes; ++a)
    EXPECT_LT((state.force.middleCols(n * a, n) - all.state(a)).norm(), kRoundoff * all.state(a).norm()) << a;
}

// In a viscoelastic body in one ratio no node lags farther than the product of all lags says, nor has it
// changed by more since the point before.
TEST(CreepHistory, bounds_how_far_nodes_lag) {
  const Ring ring({law({0.2, 0.2, 0.1})}, VectorXd::Ones(1));
  const double largest = ring.D(0, 0).eigenvalues().real().maxCoeff();
  CreepHistory history(ring.laws(), kNodes);
  for (int number = 0; number < 2 * kTurn; ++number) {
    const NodalForces forces = load(number);
    const CreepHistory::Response response = ring.response(forces);
    std::vector<Vector3d> before;
    for (int a = 0; a < kNodes; a += 7) before.push_back(history.lag(a, response));
    const CreepHistory::Lag lag =
        history.set_point(body::Moduli::relaxing, {step_length(number), 1}, response);
    for (int i = 0; 7 * i < kNodes; ++i) {
      const Vector3d now = history.lag(7 * i, response);
      ASSERT_LE(now.squaredNorm(), largest * lag.product * (1 + kRoundoff)) << number;
      const double change = (now - before[static_cast<std::size_t>(i)]).norm();
      ASSERT_LE(change, std::sqrt(largest * lag.product_change) * (1 + kRoundoff) + 1e-12 * now.norm())
          << number;
    }
    step(history, ring, number);
  }
}

TEST(CreepHistory, goes_on_from_an_archive_to_the_bit) {
  const Ring ring = two_laws();
  CreepHistory first(ring.laws(), kNodes), second(ring.laws(), kNodes);
  constexpr int kHalf = kTurn + 77;
  for (int number = 0; number < kHalf; ++number) step(first, ring, number);
  Archive out;
  first.serialize(out);
  Archive in(out.numbers());
  second.serialize(in);
  in.finish();
  for (int number = kHalf; number < 2 * kTurn; ++number) {
    step(first, ring, number);
    step(second, ring, number);
  }
  const NodalForces forces = load(2 * kTurn);
  const CreepHistory::Response response = ring.response(forces);
  for (int a = 0; a < kNodes; ++a) EXPECT_EQ(first.lag(a, response), second.lag(a, response));
  EXPECT_EQ(first.loss(), second.loss());
  EXPECT_EQ(first.twice_energy(forces, response), second.twice_energy(forces, response));
}

// States that have decayed below roundoff of the largest are gone.
TEST(CreepHistory, forgets_what_has_decayed) {
  const body::RelaxationLaw fast{VectorXd::Constant(1, 0.5), MatrixXd::Constant(1, 1, 0.4)};
  const Ring ring({fast}, VectorXd::Ones(1));
  CreepHistory history(ring.laws(), kNodes);
  OneByOne all(ring);
  for (int number = 0; number < kTurn; ++number) {
    step(history, ring, number);
    all.step(step_length(number), load(number));
  }
  model::RelaxedState state;
  history.get(state);
  EXPECT_LT(state.node.size(), 40u);
  const NodalForces forces = load(kTurn - 1);
  const CreepHistory::Response response = ring.response(forces);
  for (int a = 0; a < kNodes; ++a)
    EXPECT_LT((history.lag(a, response) - all.lag(a)).norm(), kRoundoff * all.lag(forces.node[1]).norm());
}

}  // namespace
}  // namespace elastogear::creep_history_test
