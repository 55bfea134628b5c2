// Loads that are smooth to a mesh: resultant, centroid, continuity, and the half-space below them.

#include "contact/stations/smooth_load.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>
#include <vector>

#include "flank_grids.h"

namespace elastogear::contact::smooth_load_test {
namespace {

const std::vector<double> kRows{2e-3, 2.8e-3, 4.1e-3, 5e-3, 6.6e-3}, kLayers{-12e-3, -7e-3, 0, 4e-3, 13e-3};

TEST(AcrossLoad, keeps_force_centroid_and_width_up_to_the_ends) {
  for (double v = 2e-3; v < 6.6e-3; v += 1e-4) {
    const AcrossLoad load = across_load(v, 0.9e-3, 2e-3, 6.6e-3);
    const double width = load.to - load.from;
    EXPECT_NEAR(width, 1.8e-3, 1e-12);
    EXPECT_GE(load.from, 2e-3 - 1e-12);
    EXPECT_LE(load.to, 6.6e-3 + 1e-12);
    EXPECT_NEAR(load.middle() + load.tilt * width * width / 12, v, 1e-12);
  }
  const AcrossLoad whole = across_load(3e-3, 9e-3, 2e-3, 6.6e-3);
  EXPECT_NEAR(whole.from, 2e-3, 1e-12);
  EXPECT_NEAR(whole.to, 6.6e-3, 1e-12);
}

TEST(AcrossLoad, is_even_away_from_the_ends) {
  const AcrossLoad load = across_load(4.2e-3, 0.9e-3, 2e-3, 6.6e-3);
  EXPECT_NEAR(load.tilt, 0, 1e-9);
  EXPECT_NEAR(load.middle(), 4.2e-3, 1e-12);
}

TEST(SpreadAlong, keeps_the_force_and_is_symmetric_on_even_strips) {
  std::vector<Strip> strips;
  for (const StationPlace& station : even_stations(9, -5, 4, 0)) strips.push_back(station.face);
  for (double c : {0., 0.3, 2.2, 30.}) {
    const Eigen::MatrixXd share = spread_along(strips, c);
    EXPECT_LT((share.rowwise().sum().array() - 1).abs().maxCoeff(), 1e-12) << c;
    EXPECT_LT((share - share.transpose()).norm(), 1e-12) << c;
    EXPECT_GE(share.minCoeff(), -1e-12);
  }
  EXPECT_LT((spread_along(strips, 1e4).array() - 1. / 9).abs().maxCoeff(), 1e-3);
  strips[3] = {-2, -1.5};
  EXPECT_ANY_THROW(spread_along(strips, 0.3));
  EXPECT_LT((spread_along({{0, 1}, {1, 3}, {3, 3.5}}, 0.8).rowwise().sum().array() - 1).abs().maxCoeff(),
            1e-12);
}

TEST(ConsistentWeights, sum_to_the_force_and_keep_its_place_across_the_profile) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> even;
  for (bool second_order : {false, true})
    for (int repeat = 0; repeat < 50; ++repeat) {
      const FlankGrid flank = numbered_flank(kRows, kLayers, second_order);
      const LoadWidth width{(0.2 + even(random)) * 1.2e-3, even(random) * 5e-3};
      const double slope = repeat % 2 == 0 ? 0 : 0.05 * (even(random) - 0.5);
      const auto stations = even_stations(11, -11e-3, 13e-3, 3e-3 + 2.5e-3 * even(random), slope);
      const Eigen::MatrixXd s = consistent_weights(flank, stations, width);
      EXPECT_LT((s.rowwise().sum().array() - 1).abs().maxCoeff(), 1e-12);
      const Eigen::VectorXd v = s * at_nodes(flank, [](double at, double) { return at; });
      std::vector<Strip> strips;
      Eigen::VectorXd place(11);
      for (const StationPlace& station : stations) {
        place[std::ssize(strips)] = station.v;
        strips.push_back(station.face);
      }
      EXPECT_LT((v - spread_along(strips, width.c) * place).norm(), 1e-12);
    }
}

// A load that is not spread along the face has its centroid in the middle of its strip.
TEST(ConsistentWeights, keep_the_place_along_the_face) {
  const FlankGrid flank = numbered_flank(kRows, kLayers, true);
  const auto stations = even_stations(7, -12e-3, 13e-3, 3.7e-3);
  const Eigen::MatrixXd s = consistent_weights(flank, stations, {0.9e-3, 0});
  const Eigen::VectorXd z = s * at_nodes(flank, [](double, double at) { return at; });
  for (Eigen::Index i = 0; i < 7; ++i)
    EXPECT_NEAR(z[i], stations[static_cast<std::size_t>(i)].face.centre(), 1e-12);
}

TEST(ConsistentWeights, on_triangles_in_no_rows_keep_force_and_place) {
  const FlankGrid flank = numbered_flank(kRows, kLayers, false), patches = in_patches(flank, true);
  const auto stations = even_stations(7, -12e-3, 13e-3, 3.7e-3);
  const Eigen::MatrixXd s = consistent_weights(patches, stations, {0.9e-3, 0});
  EXPECT_LT((s.rowwise().sum().array() - 1).abs().maxCoeff(), 1e-12);
  const Eigen::VectorXd v = s * at_nodes(flank, [](double at, double) { return at; }),
                        z = s * at_nodes(flank, [](double, double at) { return at; });
  for (Eigen::Index i = 0; i < 7; ++i) {
    EXPECT_NEAR(v[i], 3.7e-3, 1e-12);
    EXPECT_NEAR(z[i], stations[static_cast<std::size_t>(i)].face.centre(), 1e-12);
  }
}

TEST(ConsistentWeights, of_faces_in_no_rows_are_nearly_those_in_rows_and_layers) {
  for (bool second_order : {false, true}) {
    FlankGrid flank = numbered_flank(kRows, kLayers, second_order);
    for (std::size_t i = 0; i < flank.v_mid.size(); ++i) flank.v_mid[i] = (flank.v[i] + flank.v[i + 1]) / 2;
    const FlankGrid patches = in_patches(flank, false);
    const LoadWidth width = load_width(flank);
    EXPECT_NEAR(load_width(patches).a, width.a, 1e-15);
    EXPECT_NEAR(load_width(patches).c, width.c, 1e-15);
    for (double v : {2.1e-3, 4.4e-3, 6.2e-3}) {
      const auto stations = even_stations(5, -12e-3, 13e-3, v);
      const Eigen::MatrixXd s = consistent_weights(flank, stations, width),
                            of_patches = consistent_weights(patches, stations, width);
      EXPECT_LT((s - of_patches).norm(), 5e-3 * s.norm()) << v;
    }
  }
}

// Of shape functions that are exact for quadratic functions, the mean over the load is known.
TEST(ConsistentWeights, are_those_of_an_even_pressure) {
  const FlankGrid flank = numbered_flank({0, 1, 2.5, 4}, {0, 2, 5}, false);
  const double v = 2.2, a = 0.6;
  const auto s = consistent_weights(flank, {{{0.5, 1.7}, v}}, {a, 0});
  EXPECT_NEAR(s.row(0) * at_nodes(flank, [](double x, double z) { return x * z; }), v * 1.1, 1e-12);
}

TEST(ConsistentWeights, have_continuous_derivatives_in_the_place) {
  const FlankGrid flank = numbered_flank(kRows, kLayers, true);
  const LoadWidth width{0.9e-3, 2e-3};
  const Eigen::VectorXd u = at_nodes(flank, [](double v, double z) { return std::sin(900 * v) + 50 * z; });
  const auto mean = [&](double v) -> double {
    return consistent_weights(flank, even_stations(3, -10e-3, 10e-3, v), width).row(1) * u;
  };
  const double h = 1e-7;
  double before = 0, steepest = 0, jump = 0;
  for (double v = 2e-3 + 2 * h; v < 6.6e-3 - 2 * h; v += 2e-6) {
    const double slope = (mean(v + h) - mean(v - h)) / (2 * h);
    if (before != 0) jump = std::max(jump, std::abs(slope - before));
    steepest = std::max(steepest, std::abs(slope));
    before = slope;
  }
  EXPECT_LT(jump, 0.012 * steepest);
}

// Sum over n x n points in each of two rectangles, between which there is room.
double by_points(const AcrossLoad& across_a, const Strip& a, const AcrossLoad& across_b, const Strip& b,
                 int n) {
  double sum = 0;
  const auto at = [n](double from, double to, int i) { return from + (to - from) * (i + 0.5) / n; };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k)
        for (int l = 0; l < n; ++l) {
          const double x = at(across_a.from, across_a.to, i), y = at(across_b.from, across_b.to, j);
          const double weight = across_a.density(x) * (across_a.to - across_a.from) * across_b.density(y) *
                                (across_b.to - across_b.from);
          sum += weight / std::hypot(x - y, at(a.from, a.to, k) - at(b.from, b.to, l));
        }
  return sum / std::pow(n, 4);
}

TEST(SmoothKernel, between_loads_is_the_mean_of_inverse_distances) {
  const AcrossLoad even{-1, 1}, tilted{-0.7, 1.1, 0.9}, steep{-1.5, 0.4, -1.3};
  for (const AcrossLoad& across : {even, tilted, steep})
    for (const Strip& b : {Strip{1.5, 3}, Strip{-4, -2}, Strip{6, 7}}) {
      const double numeric = by_points(across, {0, 1}, tilted, b, 14);
      EXPECT_NEAR(smooth_inverse_distance(across, {0, 1}, tilted, b), numeric, 5e-3 * numeric);
      EXPECT_NEAR(smooth_inverse_distance(tilted, b, across, {0, 1}), numeric, 5e-3 * numeric);
    }
}

// The mean of 1/r within a unit square is 4 ln(1 + sqrt 2) - 4 (sqrt 2 - 1) / 3; a tilted load is that of its
// parts.
TEST(SmoothKernel, of_a_load_on_itself_is_that_of_its_parts) {
  const double root = std::sqrt(2.);
  EXPECT_NEAR(smooth_inverse_distance({0, 1}, {0, 1}, {0, 1}, {0, 1}),
              4 * std::log(1 + root) - 4 * (root - 1) / 3, 1e-12);
  const AcrossLoad tilted{-1, 1, 0.8};
  const Strip strip{0, 1.3};
  constexpr int kParts = 80;
  double sum = 0;
  for (int i = 0; i < kParts; ++i)
    for (int j = 0; j < kParts; ++j) {
      const double h = 2. / kParts, x = -1 + i * h, y = -1 + j * h;
      sum += tilted.density(x + h / 2) * tilted.density(y + h / 2) * h * h *
             smooth_inverse_distance({x, x + h}, strip, {y, y + h}, strip);
    }
  EXPECT_NEAR(smooth_inverse_distance(tilted, strip, tilted, strip), sum, 5e-4 * sum);
}

TEST(SmoothKernel, of_stations_is_symmetric_and_positive_definite) {
  const FlankGrid flank = numbered_flank(kRows, kLayers, true);
  for (double slope : {0., 0.1})
    for (double v : {2.1e-3, 4e-3, 6.5e-3}) {
      const auto stations = even_stations(16, -10e-3, 10e-3, v, slope);
      const FreeEnds ends{-12e-3, 13e-3};
      const Eigen::MatrixXd H = smooth_kernel(flank, stations, {0.9e-3, 0.5e-3}, ends, {1.05, 1 / 1.05});
      EXPECT_LT((H - H.transpose()).norm(), 1e-12 * H.norm());
      EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(H).eigenvalues().minCoeff(), 0);
    }
}

}  // namespace
}  // namespace elastogear::contact::smooth_load_test
