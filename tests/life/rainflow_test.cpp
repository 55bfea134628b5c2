#include "elastogear/life/rainflow.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <random>

#include "../message_of.h"

namespace elastogear::life::rainflow_test {
namespace {

// Counts by range and mean.
using Spectrum = std::map<std::pair<double, double>, double>;

Spectrum spectrum(const std::vector<Cycle>& cycles) {
  Spectrum all;
  for (const Cycle& c : cycles) all[{c.range, c.mean}] += c.count;
  return all;
}

std::map<double, double> by_range(const std::vector<Cycle>& cycles) {
  std::map<double, double> all;
  for (const Cycle& c : cycles) all[c.range] += c.count;
  return all;
}

Eigen::VectorXd values(std::initializer_list<double> list) {
  return Eigen::Map<const Eigen::VectorXd>(list.begin(), static_cast<Eigen::Index>(list.size()));
}

// Closes cycles of points 2 and 3 of any four of which 1 and 4 lie outside, whatever their order; what is
// left, in `points`, diverges and then converges.
std::vector<Cycle> four_points(std::vector<double>& points) {
  std::vector<Cycle> cycles;
  for (std::size_t i = 0; i + 3 < points.size();) {
    const double *p = &points[i], low = std::min(p[1], p[2]), high = std::max(p[1], p[2]);
    if (std::min(p[0], p[3]) <= low && high <= std::max(p[0], p[3])) {
      cycles.push_back({high - low, (high + low) / 2, 1});
      points.erase(points.begin() + static_cast<long>(i) + 1, points.begin() + static_cast<long>(i) + 3);
      i = i < 2 ? 0 : i - 2;
    } else {
      ++i;
    }
  }
  return cycles;
}

// Of a history that is repeated for ever: what the residue twice behind itself closes once more.
std::vector<Cycle> four_points_repeated(const Eigen::VectorXd& history) {
  std::vector<double> points = turning_points(history);
  std::vector<Cycle> cycles = four_points(points);
  Eigen::VectorXd twice(2 * points.size());
  twice << Eigen::Map<Eigen::VectorXd>(points.data(), static_cast<long>(points.size())),
      Eigen::Map<Eigen::VectorXd>(points.data(), static_cast<long>(points.size()));
  std::vector<double> residue = turning_points(twice);
  for (const Cycle& c : four_points(residue)) cycles.push_back(c);
  return cycles;
}

Eigen::VectorXd random_history(std::mt19937& random, int n, bool whole) {
  std::normal_distribution<double> normal(0, 4);
  Eigen::VectorXd history(n);
  for (double& value : history) value = whole ? std::round(normal(random)) : normal(random);
  return history;
}

// ASTM E1049-85 (2017), 5.4.4 with figure 6.
TEST(Rainflow, counts_the_example_of_astm_e1049) {
  const auto cycles = rainflow(values({-2, 1, -3, 5, -1, 3, -4, 4, -2}), Ends::open);
  const std::map<double, double> expected = {{3, 0.5}, {4, 1.5}, {6, 0.5}, {8, 1}, {9, 0.5}};
  EXPECT_EQ(by_range(cycles), expected);
  const Spectrum with_means = {{{3, -0.5}, 0.5}, {{4, -1}, 0.5}, {{4, 1}, 1},  {{8, 1}, 0.5},
                               {{9, 0.5}, 0.5},  {{8, 0}, 0.5},  {{6, 1}, 0.5}};
  EXPECT_EQ(spectrum(cycles), with_means);
}

// ASTM E1049-85 (2017), 5.4.5 with figure 7: the same history, repeated.
TEST(Rainflow, counts_the_example_of_astm_e1049_for_repeating_histories) {
  const auto cycles = rainflow(values({-2, 1, -3, 5, -1, 3, -4, 4, -2}), Ends::repeated);
  const std::map<double, double> expected = {{3, 1}, {4, 1}, {7, 1}, {9, 1}};
  EXPECT_EQ(by_range(cycles), expected);
}

TEST(Rainflow, of_a_repeated_history_does_not_depend_on_where_it_begins) {
  std::mt19937 random(1);
  const Eigen::VectorXd history = random_history(random, 101, true);
  const Spectrum expected = spectrum(rainflow(history, Ends::repeated));
  for (int begin = 1; begin < 101; ++begin) {
    Eigen::VectorXd turned(101);
    turned << history.tail(101 - begin), history.head(begin);
    EXPECT_EQ(spectrum(rainflow(turned, Ends::repeated)), expected);
  }
}

TEST(Rainflow, by_three_points_is_that_by_four_of_repeated_histories) {
  std::mt19937 random(2);
  for (int i = 0; i < 400; ++i) {
    const Eigen::VectorXd history = random_history(random, 2 + i % 97, i % 2 == 0);
    EXPECT_EQ(spectrum(rainflow(history, Ends::repeated)), spectrum(four_points_repeated(history)))
        << history.transpose();
  }
}

TEST(Rainflow, by_three_points_is_that_by_four_with_a_residue_of_half_cycles) {
  std::mt19937 random(3);
  for (int i = 0; i < 400; ++i) {
    const Eigen::VectorXd history = random_history(random, 2 + i % 97, false);
    std::vector<double> points = turning_points(history);
    std::vector<Cycle> cycles = four_points(points);
    for (std::size_t k = 0; k + 1 < points.size(); ++k)
      cycles.push_back({std::abs(points[k + 1] - points[k]), (points[k + 1] + points[k]) / 2, 0.5});
    EXPECT_EQ(spectrum(rainflow(history, Ends::open)), spectrum(cycles)) << history.transpose();
  }
}

TEST(Rainflow, counts_what_lies_on_the_way_and_what_stays_as_nothing) {
  const Spectrum expected = {{{2, 1}, 1}};
  EXPECT_EQ(spectrum(rainflow(values({0, 0, 0.5, 1, 1, 2, 2, 1.5, 0}), Ends::repeated)), expected);
  EXPECT_TRUE(rainflow(values({3, 3, 3}), Ends::repeated).empty());
  EXPECT_TRUE(rainflow(values({3}), Ends::open).empty());
  EXPECT_TRUE(rainflow(values({}), Ends::repeated).empty());
}

TEST(Rainflow, refuses_what_is_no_number) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(test::message_of([&] {
              rainflow(values({0, nan}), Ends::open);
            }),
            "rainflow counting: a value of the history is not finite");
}

}  // namespace
}  // namespace elastogear::life::rainflow_test
