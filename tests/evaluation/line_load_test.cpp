#include "evaluation/load/line_load.h"

#include <gtest/gtest.h>

#include <cmath>

namespace elastogear::evaluation::line_load_test {
namespace {

constexpr double kWidth = 0.04, kMean = 250e3;  // m, N/m

// Load of stations over rigid bodies on a Winkler layer of stiffness c (N/m^2) with the gap h(z), under the
// mean line load kMean: c (delta - h) where that is > 0.
template <class Gap>
double face_load_factor_of(double c, const Gap& h) {
  const int n = 401;
  const Eigen::VectorXd z = Eigen::VectorXd::LinSpaced(n, -kWidth / 2, kWidth / 2);
  double low = -1e-3, high = 1e-3;
  const auto load = [&](double delta) {
    Eigen::VectorXd force(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const double share = kWidth / (n - 1) * (i == 0 || i == n - 1 ? 0.5 : 1);
      force[i] = share * c * std::max(0.0, delta - h(z[i]));
    }
    return force;
  };
  for (int step = 0; step < 80; ++step) {
    const double delta = (low + high) / 2;
    (load(delta).sum() < kMean * kWidth ? low : high) = delta;
  }
  const FaceStations at = at_layers(z);
  LineLoad all{at, line_load(at, z, load(high)).transpose()};
  return face_load_factor(all);
}

TEST(LineLoad, of_an_even_load_is_even_wherever_the_forces_stand) {
  const FaceStations stations = at_layers((Eigen::VectorXd(4) << -0.02, -0.01, 0, 0.02).finished());
  const Eigen::VectorXd z = Eigen::VectorXd::LinSpaced(4000, -0.019995, 0.019995);
  const Eigen::VectorXd w = line_load(stations, z, Eigen::VectorXd::Constant(4000, kMean * kWidth / 4000));
  for (double value : w) EXPECT_NEAR(value, kMean, 1e-5 * kMean);
}

TEST(LineLoad, keeps_force_and_moment) {
  const FaceStations stations = at_layers(Eigen::VectorXd::LinSpaced(5, -0.02, 0.02));
  const Eigen::Vector3d z(-0.013, 0.004, 0.0199), f(3, 5, 7);
  const Eigen::VectorXd w = line_load(stations, z, f);
  const Eigen::VectorXd force = w.cwiseProduct(stations.widths());
  EXPECT_NEAR(force.sum(), 15, 1e-12);
  EXPECT_NEAR(force.dot(stations.z), f.dot(z), 1e-14);
}

TEST(FaceLoadFactor, of_aligned_uncrowned_bodies_is_one) {
  EXPECT_NEAR(face_load_factor_of(15e9, [](double) { return 0; }), 1, 1e-9);
}

// With the whole width in contact 1 + c phi b/(2 w_m), otherwise sqrt(2 c phi b/w_m).
TEST(FaceLoadFactor, of_a_misaligned_rigid_body_on_a_winkler_layer) {
  const double c = 15e9;
  for (double phi : {2e-4, 6e-4, 2e-3, 5e-3}) {
    const double uneven = c * phi * kWidth / (2 * kMean);
    const double expected = uneven <= 1 ? 1 + uneven : 2 * std::sqrt(uneven);
    EXPECT_NEAR(face_load_factor_of(c, [=](double z) { return phi * z; }) / expected, 1, 5e-3) << phi;
  }
}

// Gap C (2z/b)^2: with the whole width in contact 1 + c C/(3 w_m).
TEST(FaceLoadFactor, of_a_crowned_rigid_body_on_a_winkler_layer) {
  const double c = 15e9, C = 8e-6;
  ASSERT_LT(2 * c * C / 3, kMean);
  EXPECT_NEAR(face_load_factor_of(c, [=](double z) { return C * std::pow(2 * z / kWidth, 2); }),
              1 + c * C / (3 * kMean), 1e-4);
}

TEST(FaceLoadFactor, is_that_of_the_mean_over_the_run_and_none_without_load) {
  LineLoad load{at_layers(Eigen::Vector3d(-1, 0, 1)), Eigen::MatrixXd(2, 3)};
  load.value << 2, 1, 0, 0, 1, 2;
  EXPECT_DOUBLE_EQ(face_load_factor(load), 1);
  load.value << 4, 2, 0, 2, 1, 0;
  EXPECT_DOUBLE_EQ(face_load_factor(load), 2);
  load.value.setZero();
  EXPECT_TRUE(std::isnan(face_load_factor(load)));
}

}  // namespace
}  // namespace elastogear::evaluation::line_load_test
