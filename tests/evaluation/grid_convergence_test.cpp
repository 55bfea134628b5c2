#include "elastogear/evaluation/grid_convergence.h"

#include <gtest/gtest.h>

#include <cmath>

#include "elastogear/base/error.h"

namespace elastogear::evaluation {
namespace {

// 420 less what meshes of an order lack.
std::vector<double> values(double order, const std::vector<double>& refinement) {
  std::vector<double> all;
  for (double r : refinement) all.push_back(420 - 10 * std::pow(r, -order));
  return all;
}

// Of a figure of the assumed order the estimate is the error times the factor of safety.
TEST(GridConvergence, two_meshes_of_the_assumed_order) {
  EXPECT_NEAR(mesh_error(values(2, {1, 1.5}), {1, 1.5}), 3 * 10 / 2.25, 1e-9);
}

TEST(GridConvergence, figures_of_the_first_order) {
  EXPECT_NEAR(mesh_error(values(1, {1, 1.5}), {1, 1.5}, 1), 3 * 10 / 1.5, 1e-9);
  const std::vector<double> r = {1, 1.5, 2};
  EXPECT_NEAR(mesh_error(values(1.5, r), r, 1),
              1.25 * 10 * std::pow(2, -1.5) * (std::pow(4 / 3., 1.5) - 1) * 3, 1e-6);
  EXPECT_NEAR(mesh_error({410, 421, 419}, r, 1), 3 * 11 / 0.5 * 0.75, 1e-9);
}

TEST(GridConvergence, three_meshes_of_an_observed_order) {
  const std::vector<double> r = {1, 1.5, 2};
  EXPECT_NEAR(mesh_error(values(1.5, r), r), 1.25 * 10 * std::pow(2, -1.5), 1e-6);
}

// A higher order than the assumed one is not trusted: the estimate is farther above the error.
TEST(GridConvergence, three_meshes_of_a_higher_order) {
  const std::vector<double> r = {1, 1.5, 2};
  EXPECT_GT(mesh_error(values(3, r), r), 1.25 * 10 / 8.0);
}

// Changes to and fro show no order: the larger estimate of two meshes counts.
TEST(GridConvergence, changes_to_and_fro) {
  EXPECT_NEAR(mesh_error({410, 421, 419}, {1, 1.5, 2}), 3 * 11 / 1.25 / (4 / 2.25), 1e-9);
  EXPECT_NEAR(mesh_error({410, 420, 420}, {1, 1.5, 2}), 3 * 10 / 1.25 / (4 / 2.25), 1e-9);
  EXPECT_EQ(mesh_error({420, 420, 420}, {1, 1.5, 2}), 0);
}

// A figure that two meshes give alike by chance is as uncertain as the median of all; larger errors stay.
TEST(GridConvergence, no_figure_is_taken_for_better_than_half_of_them) {
  std::vector<double> error = {12, 0.1, 1, 0};
  raise_to_median({400, -200, 100, 0}, error);  // 3, 0.05 and 1 %; a figure of zero has no share
  EXPECT_EQ(error, (std::vector<double>{12, 2, 1, 0}));
}

// The next mesh shows the order, and has the error that it was chosen for.
TEST(GridConvergence, the_least_refinement_has_the_error_that_is_wanted) {
  const double error = mesh_error(values(2, {1, 1.5}), {1, 1.5}), r = least_refinement(error, 1.2, 1.5);
  EXPECT_GT(r, 1.5);
  EXPECT_NEAR(mesh_error(values(2, {1, 1.5, r}), {1, 1.5, r}), 1.2, 1e-6);
}

TEST(GridConvergence, of_two_figures_the_mean_share_counts) {
  std::vector<double> error = {12, 2};
  raise_to_median({400, 200}, error);  // 3 and 1 %
  EXPECT_EQ(error, (std::vector<double>{12, 4}));
}

TEST(GridConvergence, one_figure_keeps_its_error) {
  std::vector<double> error = {12}, none;
  raise_to_median({400}, error);
  raise_to_median({}, none);
  EXPECT_EQ(error, std::vector<double>{12});
}

TEST(GridConvergence, refuses_meshes_that_are_not_finer) {
  EXPECT_THROW(mesh_error({410, 420}, {2, 2}), Error);
  EXPECT_THROW(mesh_error({410}, {2}), Error);
}

}  // namespace
}  // namespace elastogear::evaluation
