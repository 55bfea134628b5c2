// The states of relaxation between which static responses are interpolated, and the laws between them.

#include "reduction/job/relaxed_states.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "elastogear/body/creep.h"

namespace elastogear::relaxed_states_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kTolerance = 1e-2;  // what the choice promises
const std::vector<double> kTimes = {1e-5, 1e-2, 10, 1e4};

fem::RelaxingModuli part_of(int region, const std::vector<double>& g,
                            model::ModulusPart part = model::ModulusPart::both) {
  return {region, part, g, kTimes};
}

VectorXd shares(const std::vector<fem::RelaxingModuli>& parts, double s) {
  VectorXd gamma = VectorXd::Zero(static_cast<Eigen::Index>(parts.size()));
  for (std::size_t p = 0; p < parts.size(); ++p)
    for (std::size_t i = 0; i < kTimes.size(); ++i)
      gamma[static_cast<Eigen::Index>(p)] += parts[p].g[i] / (1 + kTimes[i] * s);
  return gamma;
}

TEST(RelaxedStates, of_one_series_begin_with_the_relaxed_body) {
  int before = 0;
  for (double g : {0.01, 0.1, 0.3, 0.6, 0.8, 0.9, 0.95}) {
    const auto states = reduction::choose_relaxed_states({part_of(0, {g / 4, g / 4, g / 4, g / 4})});
    std::printf("g = %g: %d states, error %.1e\n", g, states.size(), states.error);
    ASSERT_GE(states.size(), before);
    EXPECT_LE(states.error, kTolerance);
    if (states.size() > 0) {
      EXPECT_NEAR(states.share(0, 0), g, 1e-15);
      EXPECT_EQ(states.law(0, 0), 1);
    }
    before = states.size();
  }
  EXPECT_EQ(reduction::choose_relaxed_states({part_of(0, {0.15, 0.15, 0.15, 0.15})}).size(), 3);
}

TEST(RelaxedStates, need_something_that_relaxes) {
  EXPECT_EQ(reduction::choose_relaxed_states({}).size(), 0);
  EXPECT_EQ(reduction::choose_relaxed_states({part_of(0, {0, 0, 0, 0})}, 3).size(), 0);
}

TEST(RelaxedStates, of_parts_with_one_series_are_those_of_one_part) {
  const auto one = reduction::choose_relaxed_states({part_of(0, {0.2, 0.2, 0.1, 0.1})});
  const auto two =
      reduction::choose_relaxed_states({part_of(0, {0.2, 0.2, 0.1, 0.1}), part_of(1, {0.2, 0.2, 0.1, 0.1})});
  ASSERT_EQ(one.size(), two.size());
  EXPECT_EQ(one.law.col(0), two.law.col(0));
  EXPECT_EQ(two.law.col(1), VectorXd::Zero(one.size()));
  EXPECT_EQ(two.share.row(0), two.share.row(1));
}

// Compliance of a structure of eight displacements, of which two parts relax, beside its interpolation.
TEST(RelaxedStates, interpolate_the_response_of_a_structure) {
  std::srand(3);
  MatrixXd K = 0.1 * MatrixXd::Identity(8, 8);
  std::vector<MatrixXd> K_p;
  for (int p = 0; p < 3; ++p) {
    const MatrixXd A = MatrixXd::Random(8, 4);
    K_p.emplace_back(A * A.transpose());
    K += K_p.back();  // the last one is elastic
  }
  const std::vector<fem::RelaxingModuli> parts = {part_of(0, {0.3, 0.1, 0.1, 0.2}),
                                                  part_of(1, {0, 0.2, 0.1, 0.1})};
  const auto response = [&](const VectorXd& gamma) {
    return MatrixXd((K - gamma[0] * K_p[0] - gamma[1] * K_p[1]).inverse());
  };
  const auto states = reduction::choose_relaxed_states(parts);
  model::Flexibility flexibility;
  flexibility.law = states.law;
  for (int k = 0; k < states.size(); ++k) flexibility.relaxed.push_back({states.share.col(k), {}});
  const MatrixXd C = body::creep_coefficients(flexibility);
  std::vector<MatrixXd> D(static_cast<std::size_t>(C.cols()), MatrixXd::Zero(8, 8));
  for (Eigen::Index j = 0; j < C.cols(); ++j)
    for (Eigen::Index k = 0; k < C.rows(); ++k)
      D[static_cast<std::size_t>(j)] +=
          C(k, j) * response(k == 0 ? VectorXd::Zero(2).eval() : states.share.col(k - 1).eval());
  double worst = 0;
  for (double s = 1e-7; s < 1e8; s *= 2) {
    const VectorXd gamma = shares(parts, s), L = (1 - (states.law * gamma).array()).inverse();
    MatrixXd sum = D[0];
    for (Eigen::Index j = 1; j < C.cols(); ++j) sum += L[j - 1] * D[static_cast<std::size_t>(j)];
    worst = std::max(worst, (sum - response(gamma)).norm() / response(gamma).norm());
  }
  std::printf("structure of two relaxing parts: %d states, error %.1e\n", states.size(), worst);
  EXPECT_LT(worst, kTolerance);
}

}  // namespace
}  // namespace elastogear::relaxed_states_test
