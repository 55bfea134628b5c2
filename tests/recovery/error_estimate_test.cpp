#include "recovery/error_estimate.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "elastogear/recovery/stress.h"
#include "recovery/mode_acceleration.h"

namespace elastogear::recovery::error_estimate_test {
namespace {

constexpr double kRoundoff = 1e-12;
constexpr int kModes = 6, kNodes = 3, kTimes = 5;

struct Recovered {
  model::ElasticBody body;
  std::vector<int> members = {0, 1, 2};
  SplitCoordinates q;
  RecoveredStress stress;

  Recovered() {
    std::srand(1);
    const Eigen::VectorXd stiffness = Eigen::VectorXd::LinSpaced(kModes, 1, 30).cwiseAbs2();
    body.K_r = Eigen::MatrixXd(stiffness.asDiagonal()).sparseView();
    body.stress.node = {10, 20, 30};
    body.stress.Psi = model::DenseRows(Eigen::MatrixXd::Random(6 * kNodes, kModes));
    q = {Eigen::MatrixXd::Zero(kModes, kTimes), Eigen::MatrixXd::Random(kModes, kTimes)};
    stress = {1e8 * Eigen::MatrixXd::Random(6 * kNodes, kTimes),
              1e7 * Eigen::MatrixXd::Random(6 * kNodes, kTimes)};
  }
  StressError error() const { return reduction_error(body, upper_modes_stress(body, members), q, stress); }
};

// Vibrations of the modes stay, the static response to forces and moments at markers goes.
TEST(DynamicPart, is_told_from_loads_at_markers_by_attachment_modes) {
  std::srand(2);
  const Eigen::VectorXd stiffness = Eigen::VectorXd::LinSpaced(kModes + 6, 1, 300).cwiseAbs2();
  model::ElasticBody body;
  body.K_r = Eigen::MatrixXd(stiffness.asDiagonal()).sparseView();
  body.n_attachments = 6;
  const Eigen::MatrixXd Phi = Eigen::MatrixXd::Random(6, kModes + 6), w = Eigen::MatrixXd::Random(6, kTimes);
  body.markers = {{"end", Eigen::Vector3d::Zero(), true, model::DenseRows(Phi)}};
  Eigen::MatrixXd vibration = Eigen::MatrixXd::Zero(kModes + 6, kTimes);
  vibration.topRows(kModes).setRandom();
  const Eigen::MatrixXd loaded = vibration + stiffness.cwiseInverse().asDiagonal() * Phi.transpose() * w;
  EXPECT_LT((without_marker_loads(body, loaded) - vibration).norm(), 1e3 * kRoundoff * vibration.norm());
  body.n_attachments = 0;
  EXPECT_EQ(without_marker_loads(body, loaded), loaded);
}

// Attachment modes are not counted among the modes whose upper half tells of those left out.
TEST(ReductionError, leaves_attachment_modes_out) {
  Recovered of;
  const Eigen::MatrixXd before = of.error().at_node;
  Eigen::VectorXd stiffness = of.body.K_r.diagonal();
  stiffness.conservativeResize(kModes + 2);
  stiffness.tail(2).setConstant(1e4);
  of.body.K_r = Eigen::MatrixXd(stiffness.asDiagonal()).sparseView();
  of.body.n_attachments = 2;
  std::get<model::DenseRows>(of.body.stress.Psi).conservativeResize(Eigen::NoChange, kModes + 2);
  std::get<model::DenseRows>(of.body.stress.Psi).rightCols(2).setConstant(1e9);
  for (Eigen::MatrixXd* q : {&of.q.q_d, &of.q.q_s}) {
    q->conservativeResize(kModes + 2, Eigen::NoChange);
    q->bottomRows(2).setOnes();
  }
  EXPECT_LT((of.error().at_node - before).norm(), kRoundoff * before.norm());
}

// Beside modes that answer statically the residual response is exact; what stays is the accuracy of forces.
TEST(ReductionError, at_rest_is_that_of_the_forces_alone) {
  const Recovered at_rest;
  const Eigen::MatrixXd found = von_mises(at_rest.stress.stress);
  EXPECT_LT((at_rest.error().at_node - 1e-3 * found).norm(), kRoundoff * found.norm());
}

TEST(ReductionError, of_modes_alone_at_rest_is_what_the_static_response_adds) {
  Recovered modal;
  modal.stress.has_residual = false;
  const Eigen::MatrixXd found = von_mises(modal.stress.stress),
                        whole = von_mises(Eigen::MatrixXd(modal.stress.stress + modal.stress.residual));
  const StressError error = modal.error();
  EXPECT_LT((error.at_node - 1e-3 * found - (whole - found).cwiseAbs()).norm(), kRoundoff * found.norm());
  for (int t = 0; t < kTimes; ++t) {
    const double missing = std::abs(whole.col(t).maxCoeff() - found.col(t).maxCoeff());
    EXPECT_GE(error.peaks.whole_error()[t], missing);
    EXPECT_LE(error.peaks.whole_error()[t], missing + 2e-3 * found.col(t).maxCoeff());
  }
}

TEST(ReductionError, of_what_has_crept_is_a_hundredth_of_its_stress) {
  Recovered crept;
  const Eigen::MatrixXd before = crept.error().at_node;
  crept.stress.crept = 1e7 * Eigen::MatrixXd::Random(6 * kNodes, kTimes);
  const Eigen::MatrixXd more = crept.error().at_node - before, stress = von_mises(crept.stress.crept);
  EXPECT_LT((more - 1e-2 * stress).norm(), kRoundoff * before.norm());
}

// K q - K_1 w = h under static forces h, whatever has crept; and the instantaneous response to others
// besides.
TEST(ReductionError, of_a_body_that_relaxes_knows_the_dynamic_part_from_what_has_crept) {
  Recovered relaxing;
  model::ElasticBody& body = relaxing.body;
  const Eigen::MatrixXd A = Eigen::MatrixXd::Random(kModes, kModes);
  body.relaxing.resize(1);
  body.relaxing[0].K = Eigen::MatrixXd(A * A.transpose()).sparseView();
  const Eigen::MatrixXd w = Eigen::MatrixXd::Random(kModes, kTimes),
                        h = Eigen::MatrixXd::Random(kModes, kTimes),
                        inertia = Eigen::MatrixXd::Random(kModes, kTimes);
  const auto over_K = [&](const Eigen::MatrixXd& x) -> Eigen::MatrixXd {
    return body.K_r.diagonal().cwiseInverse().asDiagonal() * x;
  };
  const Eigen::MatrixXd q = over_K(h + inertia + body.relaxing[0].K * w),
                        q_d = inertial_part(body, q - over_K(h), w);
  EXPECT_LT((q_d - over_K(inertia)).norm(), kRoundoff * q.norm());
}

TEST(ReductionError, grows_with_the_dynamic_part_of_the_upper_modes_and_not_of_the_lower_ones) {
  Recovered lower, upper;
  const double at_rest = Recovered().error().at_node.norm();
  lower.q.q_d.topRows(kModes / 2).setConstant(1e8);
  upper.q.q_d.bottomRows(kModes / 2).setConstant(1e8);
  EXPECT_NEAR(lower.error().at_node.norm(), at_rest, kRoundoff * at_rest);
  EXPECT_GT(upper.error().at_node.norm(), 10 * at_rest);
}

TEST(ReductionError, does_not_depend_on_the_times_of_output) {
  Recovered all;
  all.q.q_d = Eigen::MatrixXd::Random(kModes, kTimes);
  Recovered one = all;
  one.q = {all.q.q_d.col(2), all.q.q_s.col(2)};
  one.stress.stress = all.stress.stress.col(2).eval();
  one.stress.residual = all.stress.residual.col(2).eval();
  EXPECT_EQ(one.error().at_node, all.error().at_node.col(2));
  EXPECT_EQ(one.error().peaks.whole_error()[0], all.error().peaks.whole_error()[2]);
}

}  // namespace
}  // namespace elastogear::recovery::error_estimate_test
