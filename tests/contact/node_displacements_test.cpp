// Displacements as combinations of those of earlier stages: the rows of the basis are taken away, so that
// only combinations can be right.
#include "contact/search/node_displacements.h"

#include <gtest/gtest.h>

#include "surfaces.h"

namespace elastogear::contact::node_displacements_test {
namespace {

constexpr Eigen::Index kModes = 600;
constexpr double kRoundoff = 1e-12;  // of the displacement, over some combinations with weights up to 4

// Steps of Newmark's method with random corrections, as the stages of a time integrator.
class Stages {
 public:
  Stages() : v_(Eigen::VectorXd::Random(kModes)), a_(Eigen::VectorXd::Random(kModes)), q_(a_ + v_) {}

  Eigen::VectorXd start() const { return q_; }
  Eigen::VectorXd predicted(double h) const { return q_ + 0.5 * (h * v_ + h * h / 2 * a_); }
  // Moves on by a step; the stage half way.
  Eigen::VectorXd corrected(double h) {
    const Eigen::VectorXd change = 0.1 * Eigen::VectorXd::Random(kModes);
    const Eigen::VectorXd stage = predicted(h) + 0.5 * change;
    q_ += h * v_ + h * h / 2 * a_ + change;
    v_ += h * a_ + 2 / h * change;
    a_ += 4 / (h * h) * change;
    return stage;
  }

 private:
  Eigen::VectorXd v_, a_, q_;
};

struct NodesOfStages : testing::Test {
  NodesOfStages() : surface(test::plane(2, 2)) {
    Phi = model::DenseRows::Random(3 * surface.X.cols(), kModes);
    surface.Phi = Phi;
  }
  void take_rows_away() { surface.Phi = model::DenseRows(model::DenseRows::Zero(Phi.rows(), kModes)); }
  void give_rows_back() { surface.Phi = Phi; }
  void look(NodeDisplacements& displaced, const Eigen::VectorXd& q) const {
    displaced.start(q);
    for (int node = 0; node < surface.X.cols(); ++node) {
      const Eigen::Vector3d u = Phi.middleRows<3>(3 * node) * q;
      EXPECT_LE((displaced.at(node) - u).norm(), kRoundoff * q.norm()) << "node " << node;
    }
  }

  model::Surface surface;
  model::DenseRows Phi;
};

TEST_F(NodesOfStages, need_rows_for_one_stage_of_a_step) {
  NodeDisplacements displaced(surface);
  Stages stages;
  const double h = 0.7;
  for (int step = 0; step < 12; ++step) {
    if (step > 2) take_rows_away();
    look(displaced, stages.predicted(h));
    give_rows_back();
    look(displaced, stages.corrected(h));
    if (step > 0) take_rows_away();
    look(displaced, stages.start());
    give_rows_back();
  }
}

// No combination of zeros is a number that is not zero.
TEST_F(NodesOfStages, are_right_where_coordinates_were_zero_before) {
  NodeDisplacements displaced(surface);
  Eigen::VectorXd q = Eigen::VectorXd::Zero(kModes);
  for (int stage = 0; stage < 4; ++stage) {
    q.head(kModes / 2).array() = 1e-6 * (stage + 1) * (stage + 1);
    look(displaced, q);
  }
  q.setConstant(1e-6);
  look(displaced, q);
}

TEST_F(NodesOfStages, are_right_where_steps_change_and_nodes_come_late) {
  NodeDisplacements displaced(surface);
  Stages stages;
  for (int step = 0; step < 100; ++step) {
    const double h = step % 3 == 0 ? 0.7 : 0.5;
    displaced.start(stages.predicted(h));
    displaced.at(step % 4);
    look(displaced, stages.corrected(h));
    look(displaced, stages.start());
  }
}

TEST_F(NodesOfStages, go_on_from_a_checkpoint_to_the_bit) {
  NodeDisplacements displaced(surface);
  Stages stages;
  for (int step = 0; step < 5; ++step)
    for (const Eigen::VectorXd& q : {stages.predicted(1), stages.corrected(1), stages.start()})
      look(displaced, q);
  Archive record;
  displaced.serialize(record);
  NodeDisplacements other(surface);
  Archive replay(record.numbers());
  other.serialize(replay);
  replay.finish();
  take_rows_away();
  const Eigen::VectorXd q = stages.predicted(1);
  displaced.start(q);
  other.start(q);
  for (int node = 0; node < surface.X.cols(); ++node) {
    EXPECT_GT(displaced.at(node).norm(), 0);
    EXPECT_EQ(displaced.at(node), other.at(node));
  }
}

TEST_F(NodesOfStages, without_a_combination_are_products) {
  NodeDisplacements displaced(surface);
  for (int look_number = 0; look_number < 12; ++look_number) look(displaced, Eigen::VectorXd::Random(kModes));
  look(displaced, Eigen::VectorXd::Zero(kModes));
}

}  // namespace
}  // namespace elastogear::contact::node_displacements_test
