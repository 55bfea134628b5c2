// Prony series fitted to master curves, against series that the curves were made of.

#include "elastogear/model/master_curve.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "../message_of.h"
#include "elastogear/base/error.h"
#include "elastogear/base/nnls.h"

namespace elastogear::master_curve_test {
using namespace model;
using Eigen::VectorXd;
using test::message_of;
using testing::HasSubstr;

namespace {

constexpr double kE = 3e9;
const std::vector<double> kShares = {0.2, 0.15, 0.1}, kTimes = {1e-2, 1, 100};

// Log-spaced, 40 in all.
VectorXd spaced(double first, double last) {
  VectorXd x(40);
  for (Eigen::Index i = 0; i < x.size(); ++i)
    x[i] = first * std::pow(last / first, static_cast<double>(i) / 39);
  return x;
}

MasterCurve relaxation(const VectorXd& time) {
  MasterCurve curve{time, VectorXd::Constant(time.size(), 0.55 * kE), {}, {}, {}};
  for (std::size_t i = 0; i < kTimes.size(); ++i)
    curve.relaxation.array() += kE * kShares[i] * (-time.array() / kTimes[i]).exp();
  return curve;
}

MasterCurve vibration(const VectorXd& frequency) {
  MasterCurve curve{
      {}, {}, frequency, VectorXd::Constant(frequency.size(), 0.55 * kE), VectorXd::Zero(frequency.size())};
  for (std::size_t i = 0; i < kTimes.size(); ++i) {
    const Eigen::ArrayXd x = 2 * std::numbers::pi * kTimes[i] * frequency.array();
    curve.storage.array() += kE * kShares[i] * x.square() / (1 + x.square());
    curve.loss.array() += kE * kShares[i] * x / (1 + x.square());
  }
  return curve;
}

void expect_known_series(const PronyFit& fit) {
  EXPECT_NEAR(fit.E_0, kE, 1e-6 * kE);
  ASSERT_EQ(fit.tau.size(), kTimes.size());
  for (std::size_t i = 0; i < kTimes.size(); ++i) {
    EXPECT_EQ(fit.tau[i], kTimes[i]);
    EXPECT_NEAR(fit.g[i], kShares[i], 1e-6);
  }
  EXPECT_LT(fit.largest, 1e-6);
}

TEST(Nnls, is_least_squares_where_that_is_positive_and_leaves_out_what_would_be_negative) {
  const Eigen::Matrix3d A{{2, 1, 0}, {1, 3, 1}, {0, 1, 4}};
  const Eigen::Vector3d x(1, 2, 3);
  EXPECT_LT((nonnegative_least_squares(A, A * x) - x).norm(), 1e-12);
  const Eigen::Vector3d b = A * Eigen::Vector3d(1, -2, 3);
  const VectorXd found = nonnegative_least_squares(A, b), slope = A.transpose() * (b - A * found);
  EXPECT_EQ(found[1], 0);
  EXPECT_GE(found.minCoeff(), 0);
  EXPECT_LT(slope.maxCoeff(), 1e-9);            // no coefficient would lessen the rest by growing
  EXPECT_LT(std::abs(slope.dot(found)), 1e-9);  // nor by falling
}

TEST(MasterCurve, of_a_series_gives_the_series_back) {
  const std::vector<double> among = {1e-3, 1e-2, 0.1, 1, 10, 100, 1000};
  expect_known_series(fit_prony(relaxation(spaced(1e-4, 1e4)), among));
  expect_known_series(fit_prony(vibration(spaced(1e-4, 1e4)), among));
}

TEST(MasterCurve, is_fitted_within_some_per_cent_by_one_term_a_decade) {
  for (const MasterCurve& curve : {relaxation(spaced(1e-4, 1e4)), vibration(spaced(1e-5, 1e3))}) {
    const PronyFit fit = fit_prony(curve, decade_times(curve));
    EXPECT_LE(decade_times(curve).size(), 8u);
    EXPECT_LT(fit.largest, 0.05);
    EXPECT_LE(fit.rms, fit.largest);
    EXPECT_NEAR(fit.E_0, kE, 0.02 * kE);
  }
}

TEST(MasterCurve, with_numbers_that_cannot_be_is_refused) {
  MasterCurve curve = relaxation(spaced(1, 10));
  curve.relaxation[3] = -1;
  EXPECT_THAT(message_of([&] { validate(curve, "pa.csv"); }), HasSubstr("pa.csv: modulus -1"));
  curve = relaxation(spaced(1, 10));
  curve.time[0] = 0;
  EXPECT_THAT(message_of([&] { validate(curve, "pa.csv"); }), HasSubstr("time 0"));
  EXPECT_THAT(message_of([] { validate(MasterCurve{}, "pa.csv"); }), HasSubstr("at least 2"));
}

}  // namespace
}  // namespace elastogear::master_curve_test
