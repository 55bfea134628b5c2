// Bodies that nothing holds.
#include "elastogear/reduction/free_body.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <filesystem>

#include "../fem/other_cells.h"
#include "../fem/system.h"
#include "../message_of.h"
#include "calculix.h"
#include "elastogear/io/body_file.h"
#include "elastogear/reduction/reduce.h"
#include "reduction/modes/effective_mass.h"

namespace elastogear::free_body_test {
namespace {

namespace fs = std::filesystem;

constexpr double kEigensolver = 1e-9;
constexpr double kOrthogonality = 1e-11;  // roundoff of the couplings, relative
constexpr double kSameElement = 1e-5;     // two programs, one element

bool is_root() {
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  return rank == 0;
}

int n_ranks() {
  int size = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  return size;
}

struct Solution {
  reduction::Eigenmodes modes;
  Eigen::MatrixXd Phi;  // on rank 0
};

Solution solve(const mesh::Mesh& mesh, const reduction::EigenOptions& options,
               MPI_Comm comm = PETSC_COMM_WORLD,
               const std::vector<model::MaterialRegion>& regions = test::kSteelBody) {
  const auto system = test::assemble(mesh, {}, comm, regions);
  const Mat K = system.matrices.K, M = system.matrices.M;
  UniqueVec layout;
  check(MatCreateVecs(K, layout.out(), nullptr));
  const fem::VectorGather gather(layout, system.rows);
  Solution solution;
  const auto keep = [&](int i, Vec phi) {
    const Eigen::VectorXd u = gather(phi);
    solution.Phi.conservativeResize(u.size(), i + 1);
    solution.Phi.col(i) = u;
  };
  const auto rigid = reduction::find_rigid_modes(K, M, gather, mesh.X);
  solution.modes = reduction::find_free_modes(K, M, rigid, options, keep);
  return solution;
}

mesh::Mesh block() { return test::distorted(test::brick({4, 2, 2}, {1, 0.5, 0.3}), 0.02); }

// Largest coupling of a mode to a rigid motion about the centre of mass.
double rigid_coupling(const mesh::Mesh& mesh, const Eigen::MatrixXd& Phi) {
  const auto moments = fem::mass_moments(mesh, test::kSteelBody);
  model::Inertia inertia = fem::rigid_inertia(mesh, moments);
  inertia.C_l.resize(Phi.cols(), 3);
  inertia.C_r.resize(Phi.cols(), 3);
  for (int k = 0; k < Phi.cols(); ++k) {
    inertia.C_l.row(k) = fem::translational_coupling(moments, Phi.col(k));
    inertia.C_r.row(k) = fem::rotational_coupling(fem::first_moment(moments, Phi.col(k)));
  }
  const reduction::SixDirections largest = reduction::effective_masses(inertia).colwise().maxCoeff();
  return std::sqrt(largest.cwiseQuotient(reduction::body_masses(inertia)).maxCoeff());
}

TEST(FreeModes, do_not_move_the_centre_of_mass_nor_turn_about_it) {
  auto mesh = block();
  mesh.X.colwise() += Eigen::Vector3d(0.3, -0.2, 0.4);
  for (int window : {0, 8}) {
    const auto [modes, Phi] = solve(mesh, {.n_modes = 8, .window = window});
    EXPECT_GT(modes.eigenvalue.minCoeff(), 1e6);
    EXPECT_LT(modes.residual.maxCoeff(), 1e-6);
    if (!is_root()) continue;
    EXPECT_LT(rigid_coupling(mesh, Phi), kOrthogonality) << window;
  }
}

TEST(FreeModes, do_not_depend_on_the_number_of_ranks_nor_on_the_solver) {
  const auto serial = solve(block(), {.n_modes = 8}, PETSC_COMM_SELF).modes.eigenvalue;
  for (int window : {0, 8}) {
    const auto modes = solve(block(), {.n_modes = 8, .window = window}).modes.eigenvalue;
    EXPECT_LT((modes - serial).cwiseQuotient(serial).cwiseAbs().maxCoeff(), 2 * kEigensolver) << window;
  }
}

// A cube has pairs and triples of equal eigenvalues.
TEST(FreeModes, may_be_any_part_of_the_spectrum_of_a_cube) {
  const auto cube = test::brick({3, 3, 3}, {1, 1, 1});
  const int n_all = 3 * cube.n_nodes() - 6;
  const Eigen::VectorXd all =
      solve(cube, {.n_modes = n_all, .window = reduction::kAutomaticWindow}).modes.eigenvalue;
  ASSERT_EQ(all.size(), n_all);
  int triples = 0;
  for (int i = 2; i < n_all; ++i) triples += all(i) < (1 + kEigensolver) * all(i - 2);
  EXPECT_GT(triples, 10);
  for (int n : {1, 2, 3, 40, 64, 120, n_all - 1}) {
    const auto modes = solve(cube, {.n_modes = n, .window = reduction::kAutomaticWindow}).modes;
    ASSERT_EQ(modes.eigenvalue.size(), n);
    EXPECT_LT((modes.eigenvalue.cwiseQuotient(all.head(n)).array() - 1).abs().maxCoeff(), 2 * kEigensolver)
        << n;
  }
}

TEST(FreeModes, continue_after_a_window) {
  const auto mesh = test::brick({12, 4, 4}, {1, 0.35, 0.3});
  reduction::EigenOptions options{.n_modes = 60, .window = 15};
  std::vector<reduction::SearchState> states;
  options.commit = [&](const reduction::SearchState& state) { states.push_back(state); };
  const Eigen::VectorXd whole = solve(mesh, options).modes.eigenvalue;
  ASSERT_GE(states.size(), 2u);
  options.start = states.front();
  const Eigen::VectorXd continued = solve(mesh, options).modes.eigenvalue;
  EXPECT_LT(states.front().eigenvalue.size(), 60);
  EXPECT_LT((continued - whole).cwiseQuotient(whole).cwiseAbs().maxCoeff(), 2 * kEigensolver);
}

// (beta L)^2 of the free-free Euler-Bernoulli beam.
TEST(FreeModes, of_a_slender_beam_have_euler_bernoulli_frequencies) {
  if (n_ranks() > 1) GTEST_SKIP() << "compared on one rank";
  const double L = 10, h = 0.1, I = h * h * h * h / 12, A = h * h;
  const model::Material material{210e9, 0, 7850};
  const double root[3] = {4.730040744862704, 7.853204624095838, 10.995607838001671};
  const auto modes =
      solve(test::brick({100, 2, 2}, {L, h, h}), {.n_modes = 6}, PETSC_COMM_WORLD, {{"", material}});
  for (int i = 0; i < 3; ++i) {
    const double exact = std::pow(root[i] / L, 2) * std::sqrt(material.E * I / (material.rho * A));
    for (int k : {2 * i, 2 * i + 1})  // of each pair
      EXPECT_NEAR(std::sqrt(modes.modes.eigenvalue(k)) / exact, 1, 2e-3) << k;
  }
}

TEST(FreeModes, of_a_block_equal_calculix) {
  if (!test::calculix_is_installed()) GTEST_SKIP() << "ccx is not installed";
  if (n_ranks() > 1) GTEST_SKIP() << "compared on one rank";
  constexpr int n = 20, rigid = 6;
  const auto mesh =
      test::cells_of(mesh::CellType::hex20, test::distorted(test::brick({5, 2, 2}, {1, 0.3, 0.2}), 0.01));
  const auto expected = test::calculix_frequencies({mesh, test::kSteel, {}, "C3D20"}, n + rigid);
  const auto lambda = solve(mesh, {.n_modes = n}).modes.eigenvalue;
  for (int i = 0; i < n; ++i)
    EXPECT_NEAR(std::sqrt(lambda(i)) / (2 * M_PI) / expected[i + rigid], 1, kSameElement) << i;
}

// Bricks of one row, kept where `keep` says.
mesh::Mesh some_cells(const mesh::Mesh& whole, const std::vector<int>& keep) {
  mesh::Mesh mesh = whole;
  mesh.cells = {};
  mesh.face_sets.clear();
  for (int cell : keep) mesh.cells.add(whole.cells.type[cell], whole.cells[cell]);
  return mesh;
}

TEST(FreeModes, of_two_parts_are_an_error_that_counts) {
  const auto apart = some_cells(test::brick({3, 1, 1}, {3, 1, 1}), {0, 2});
  EXPECT_THAT(test::message_of([&] { solve(apart, {.n_modes = 10}); }), testing::HasSubstr("more than six"));
  const auto hinged = some_cells(test::brick({2, 1, 2}, {2, 1, 2}), {0, 3});  // at an edge
  EXPECT_THAT(test::message_of([&] { solve(hinged, {.n_modes = 10}); }), testing::HasSubstr("more than six"));
}

TEST(FreeModes, of_a_held_body_are_an_error) {
  const auto mesh = block();
  const auto system = test::assemble(mesh, {"xmin"});
  UniqueVec layout;
  check(MatCreateVecs(system.matrices.K, layout.out(), nullptr));
  const fem::VectorGather gather(layout, system.rows);
  const auto find = [&] {
    reduction::find_rigid_modes(system.matrices.K, system.matrices.M, gather, mesh.X);
  };
  EXPECT_THAT(test::message_of(find), testing::HasSubstr("something holds the body"));
}

reduction::ReductionOptions free_options() {
  reduction::ReductionOptions options;
  options.name = "free";
  options.regions = test::kSteelBody;
  options.floating = true;
  options.surface = {"zmax"};
  options.stress_nodes = {"xmax"};
  options.n_modes = 10;
  return options;
}

std::string reduced(const mesh::Mesh& mesh, const reduction::ReductionOptions& options,
                    const std::string& name) {
  const std::string path = fs::temp_directory_path() / ("free_" + name + std::to_string(n_ranks()) + ".h5");
  reduction::reduce(PETSC_COMM_WORLD, is_root() ? mesh : mesh::Mesh{}, options, path);
  return path;
}

TEST(FreeBody, has_its_frame_where_it_is_asked_for) {
  const auto mesh = block();
  auto options = free_options();
  const std::string at_mesh = reduced(mesh, options, "mesh");
  options.frame_at_center = true;
  const std::string at_center = reduced(mesh, options, "center");
  options.frame_at_center = false;
  options.frame_origin = {1, 2, 3};
  const std::string at_point = reduced(mesh, options, "point");
  if (!is_root()) return;
  const auto a = io::read_body(at_mesh), b = io::read_body(at_center), c = io::read_body(at_point);
  const double m = a.inertia.m;
  EXPECT_TRUE(a.floating);
  EXPECT_LT(b.inertia.c.norm(), 1e-14);
  EXPECT_LT((io::read_body_source(at_center).origin - a.inertia.c).norm(), 1e-14);
  for (const auto& [body, path] :
       {std::pair(&a, at_mesh), std::pair(&b, at_center), std::pair(&c, at_point)}) {
    const auto source = io::read_body_source(path);
    const Eigen::Vector3d r = body->inertia.c;
    EXPECT_LT((source.origin + r - a.inertia.c).norm(), 1e-14) << path;
    EXPECT_LT((source.mesh.X.colwise() + source.origin - mesh.X).norm(), 1e-14) << path;
    EXPECT_EQ(source.mesh.X(Eigen::all, body->surface.node), body->surface.X);
    EXPECT_EQ(source.mesh.X(Eigen::all, body->stress.node), body->stress.X);
    const Eigen::Matrix3d steiner = m * (r.squaredNorm() * Eigen::Matrix3d::Identity() - r * r.transpose());
    EXPECT_LT((body->inertia.J - steiner - b.inertia.J).norm(), 1e-12 * body->inertia.J.norm()) << path;
    EXPECT_LT((body->frequency - b.frequency).norm(), kEigensolver * b.frequency.norm()) << path;
    EXPECT_LT(body->inertia.C_l.norm() + body->inertia.C_r.norm(), kOrthogonality * std::sqrt(m) * 10)
        << path;
  }
}

TEST(FreeBody, is_statically_complete_with_all_its_modes) {
  const auto mesh = test::distorted(test::brick({2, 2, 1}, {1, 0.8, 0.3}), 0.02);
  auto options = free_options();
  options.frame_at_center = true;
  options.n_modes = 3 * mesh.n_nodes() - 6;
  const std::string path = reduced(mesh, options, "all");
  if (!is_root()) return;
  for (const auto& check : io::read_body_source(path).checks) {
    const bool loads = check.name == "static_completeness";
    const Eigen::MatrixXd error = loads ? Eigen::MatrixXd(check.value.array() - 1) : check.value;
    EXPECT_LT(error.cwiseAbs().maxCoeff(), loads ? 1e-8 : kOrthogonality) << check.name;
  }
}

TEST(FreeBody, of_two_parts_is_an_error_before_any_work) {
  const auto mesh = some_cells(test::brick({3, 1, 1}, {3, 1, 1}), {0, 2});
  auto options = free_options();
  options.surface = {};
  EXPECT_THAT(test::message_of([&] { reduced(mesh, options, "parts"); }), testing::HasSubstr("2 parts"));
}

}  // namespace
}  // namespace elastogear::free_body_test
