// Masses on node sets.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <filesystem>

#include "../fem/brick.h"
#include "../mesh/disc.h"
#include "elastogear/base/error.h"
#include "elastogear/base/petsc.h"
#include "elastogear/io/body_file.h"
#include "elastogear/reduction/reduce.h"

namespace elastogear::point_mass_test {
namespace {

constexpr double kRoundoff = 1e-12;
constexpr double kDenseSolver = 1e-14;  // roundoff of its eigenvalues, relative to the largest

bool is_root() {
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  return rank == 0;
}

std::string output_path(const std::string& name) {
  int size = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  return (std::filesystem::temp_directory_path() / ("point_mass_" + name + std::to_string(size) + ".h5"))
      .string();
}

mesh::Mesh bar() { return test::brick({8, 1, 1}, {1, 0.02, 0.02}); }

// A bar that can only stretch is a spring E A / L in front of a mass that is far heavier than itself.
reduction::ReductionOptions options(double mass) {
  reduction::ReductionOptions o;
  o.name = "bar";
  o.regions = {{"", {2e11, 0, 1}}};
  o.restrain = {"xmin"};
  o.n_modes = 6;
  o.markers = {"xmax"};
  o.completeness = false;
  if (mass > 0) o.point_mass = {{"xmax", mass}};
  return o;
}

model::ElasticBody reduce(const mesh::Mesh& mesh, const reduction::ReductionOptions& o,
                          const std::string& name) {
  const std::string path = output_path(name);
  reduction::reduce(PETSC_COMM_WORLD, is_root() ? mesh : mesh::Mesh{}, o, path);
  return is_root() ? io::read_body(path) : model::ElasticBody{};
}

TEST(PointMass, on_a_bar_makes_it_swing_as_a_spring_and_a_mass) {
  constexpr double kMass = 0.4, kBar = 4e-4;  // kg
  constexpr double kHigherOrder = 1e-5;       // relative: (kBar / kMass)^2 and its like
  const model::ElasticBody body = reduce(bar(), options(kMass), "spring");
  if (!is_root()) return;
  // Bending modes of the long bar lie below: the stretching one moves along x.
  const auto& Phi = std::get<model::DenseRows>(body.markers[0].Phi);
  int stretching = 0;
  Phi.row(0).cwiseAbs().maxCoeff(&stretching);
  const double k = 2e11 * kBar, frequency = std::sqrt(k / (kMass + kBar / 3)) / (2 * M_PI);
  EXPECT_NEAR(body.frequency[stretching], frequency, kHigherOrder * frequency);
  EXPECT_NEAR(body.inertia.m, kMass + kBar, kRoundoff * kMass);
  EXPECT_TRUE(body.assembled_K && !body.assembled_M);
  const double tip = Phi(0, stretching);
  EXPECT_NEAR(body.inertia.C_l(stretching, 0), (kMass + kBar / 2) * tip,
              kHigherOrder * kMass * std::abs(tip));
}

TEST(PointMass, adds_to_the_rigid_inertia_also_on_restrained_nodes) {
  auto o = options(0);
  const model::ElasticBody without = reduce(bar(), o, "without");
  o.point_mass = {{"xmin", 2}, {"xmax", 3}};
  const model::ElasticBody with = reduce(bar(), o, "with");
  if (!is_root()) return;
  const double m = without.inertia.m;
  EXPECT_NEAR(with.inertia.m, m + 5, kRoundoff * 5);
  const Eigen::Vector3d c =
      (m * without.inertia.c + 2 * Eigen::Vector3d(0, 0.01, 0.01) + 3 * Eigen::Vector3d(1, 0.01, 0.01)) /
      (m + 5);
  EXPECT_LT((with.inertia.c - c).norm(), kRoundoff);
  // Four corners of a square at distance 0.01 sqrt(2) from the axis of the bar, 2e-4 m^2 each, plus the axis'
  // own.
  EXPECT_NEAR(with.inertia.J(0, 0) - without.inertia.J(0, 0), 5 * 4e-4, kRoundoff);
  EXPECT_NEAR(with.inertia.J(2, 2) - without.inertia.J(2, 2), 2 * 2e-4 + 3 * (1 + 2e-4), kRoundoff * 3);
}

TEST(PointMass, is_the_same_in_both_bases) {
  constexpr double kMass = 1e-4;
  auto o = options(kMass);
  const model::ElasticBody modal = reduce(bar(), o, "modal");
  o.basis = model::Basis::full;
  const model::ElasticBody full = reduce(bar(), o, "full");
  o.point_mass.clear();
  const model::ElasticBody without = reduce(bar(), o, "full_without");
  if (!is_root()) return;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes{Eigen::MatrixXd(full.K_r),
                                                                        Eigen::MatrixXd(full.M_r)};
  for (int i = 0; i < 6; ++i)
    EXPECT_NEAR(modal.K_r.coeff(i, i), modes.eigenvalues()[i], kDenseSolver * modes.eigenvalues().maxCoeff());
  const Eigen::MatrixXd added = Eigen::MatrixXd(full.M_r) - Eigen::MatrixXd(without.M_r);
  EXPECT_NEAR(added.trace(), 3 * kMass, kRoundoff * kMass);
  EXPECT_NEAR(added.sum(), 3 * kMass, kRoundoff * kMass);
}

TEST(PointMass, takes_the_modes_of_a_repeating_body_from_the_whole) {
  auto mesh = test::disc({5, 1, 1, 1});
  mesh.node_sets["rim"] = {mesh.n_nodes() - 1};
  reduction::ReductionOptions o{.regions = {{"", test::kSteel}}, .restrain = {"bottom"}, .n_modes = 3};
  o.point_mass = {{"rim", 1}};
  const std::string path = output_path("disc");
  const auto report = reduction::reduce(PETSC_COMM_WORLD, is_root() ? mesh : mesh::Mesh{}, o, path);
  EXPECT_EQ(report.symmetry, is_root() ? "none: point masses" : "");
}

TEST(PointMass, must_be_positive_and_on_nodes_of_the_body) {
  auto mesh = bar();
  mesh.X.conservativeResize(3, mesh.n_nodes() + 1);
  mesh.X.rightCols(1).setZero();
  mesh.node_sets["loose"] = {mesh.n_nodes() - 1};
  for (const auto& [set, mass] : {std::pair("xmax", 0.0), {"xmax", -1.0}, {"nowhere", 1.0}, {"loose", 1.0}}) {
    auto o = options(0);
    o.point_mass = {{set, mass}};
    EXPECT_THROW(reduce(mesh, o, "refused"), Error) << set;
  }
}

}  // namespace
}  // namespace elastogear::point_mass_test
