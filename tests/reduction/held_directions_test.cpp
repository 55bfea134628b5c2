// Nodes held in single directions: symmetry planes and plane strain, against closed forms and whole bodies.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>
#include <filesystem>

#include "../fem/brick.h"
#include "../mesh/disc.h"
#include "elastogear/io/body_file.h"
#include "elastogear/reduction/reduce.h"

namespace elastogear::held_directions_test {
namespace {

constexpr double kEigensolver = 1e-8;  // of frequencies, relative
constexpr double kRoundoff = 1e-9;

bool is_root() {
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  return rank == 0;
}

struct HeldDirections : testing::Test {
  std::string path = testing::TempDir() + "held_directions.h5";

  reduction::ReductionOptions options(std::vector<std::string> restrain, int n_modes) const {
    reduction::ReductionOptions o;
    o.name = "bar";
    o.regions = test::kSteelBody;
    o.restrain = std::move(restrain);
    o.n_modes = n_modes;
    return o;
  }
  reduction::ReductionReport reduce(const mesh::Mesh& mesh, const reduction::ReductionOptions& o) const {
    return reduction::reduce(PETSC_COMM_WORLD, is_root() ? mesh : mesh::Mesh(), o, path);
  }
  void TearDown() override {
    if (is_root()) std::filesystem::remove(path);
  }
};

// A bar of rectangular section, clamped at one end: the quarter between its planes of symmetry has those of
// its modes that are symmetric about both.
TEST_F(HeldDirections, on_planes_of_symmetry_give_the_symmetric_modes_of_the_whole) {
  const auto whole = reduce(test::brick({4, 4, 5}, {0.2, 0.3, 0.6}), options({"zmin"}, 60));
  const auto quarter =
      reduce(test::brick({2, 2, 5}, {0.1, 0.15, 0.6}), options({"zmin", "xmin:x", "ymin:y"}, 10));
  if (!is_root()) return;
  int found = 0;
  for (double f : quarter.frequency) {
    ASSERT_LT(f, whole.frequency(whole.frequency.size() - 1)) << "the whole needs more modes";
    double nearest = INFINITY;
    for (double g : whole.frequency) nearest = std::min(nearest, std::abs(g / f - 1));
    EXPECT_LT(nearest, kEigensolver) << f << " Hz";
    found += nearest < kEigensolver;
  }
  EXPECT_EQ(found, 10);
  EXPECT_EQ(quarter.n_free, 3 * 3 * 3 * 5 - 3 * 5 - 3 * 5);
}

// With all modes all of the mass is carried that (2.6) says can be.
TEST_F(HeldDirections, carry_all_mobile_mass_with_all_modes) {
  const auto mesh = test::distorted(test::brick({2, 1, 2}, {0.2, 0.1, 0.2}), 0.01);
  const int n_free = 3 * 18 - 6 - 9 - 6;
  const auto report = reduce(mesh, options({"xmin:x", "ymin:y", "zmin:z"}, n_free));
  if (!is_root()) return;
  EXPECT_EQ(report.n_free, n_free);
  const auto check = std::find_if(report.checks.begin(), report.checks.end(),
                                  [](const model::Check& c) { return c.name == "captured_mass"; });
  ASSERT_NE(check, report.checks.end());
  for (int a = 0; a < 6; ++a) EXPECT_NEAR(check->value(0, a), 1, kRoundoff) << a;
  EXPECT_LT(check->value.row(1).maxCoeff(), 1) << "held displacements carry mass";
}

// u_x = F l (1 - nu^2)/(E A), sigma_zz = nu sigma_xx.
TEST_F(HeldDirections, on_both_sides_of_a_strip_give_plane_strain) {
  const Eigen::Vector3d l(0.3, 0.2, 0.1);
  auto o = options({"zmin:z", "zmax:z", "xmin:x", "ymin:y"}, 1);
  o.basis = model::Basis::full;
  o.markers = {"xmax"};
  o.stress_nodes = {"ymax"};
  reduce(test::brick({3, 2, 2}, l), o);
  if (!is_root()) return;
  const model::ElasticBody body = io::read_body(path);
  constexpr double kForce = 1e4;
  Eigen::VectorXd unit = Eigen::VectorXd::Zero(6);
  unit(0) = kForce;
  const Eigen::VectorXd h = model::multiply_transposed(body.markers[0].Phi, unit);
  const Eigen::VectorXd q = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(body.K_r).solve(h);
  const model::Material& steel = test::kSteel;
  const double sigma = kForce / (l.y() * l.z());
  const double u = sigma * l.x() * (1 - steel.nu * steel.nu) / steel.E;
  EXPECT_NEAR(model::multiply(body.markers[0].Phi, q)(0) / u, 1, kRoundoff);
  const Eigen::VectorXd stress = model::multiply(body.stress.Psi, q);
  for (Eigen::Index i = 0; i < stress.size(); i += 6) {
    EXPECT_NEAR(stress(i) / sigma, 1, kRoundoff);
    EXPECT_NEAR(stress(i + 1) / sigma, 0, kRoundoff);
    EXPECT_NEAR(stress(i + 2) / sigma, steel.nu, kRoundoff);
  }
}

TEST_F(HeldDirections, leave_no_sectors) {
  auto o = options({"bottom:z", "few"}, 4);
  auto mesh = test::disc({5, 2, 3, 2});
  mesh.node_sets["few"] = {0, 7, 20};
  const auto report = reduce(mesh, o);
  if (is_root()) {
    EXPECT_THAT(report.symmetry, testing::HasSubstr("none: nodes are held in single directions"));
  }
}

}  // namespace
}  // namespace elastogear::held_directions_test
