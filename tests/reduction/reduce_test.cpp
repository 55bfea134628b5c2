#include "elastogear/reduction/reduce.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "../fem/brick.h"
#include "../mesh/disc.h"
#include "elastogear/base/error.h"
#include "elastogear/base/petsc.h"
#include "elastogear/fem/stress.h"
#include "elastogear/io/body_file.h"
#include "elastogear/reduction/marker.h"
#include "elastogear/reduction/stressed_body.h"
#include "full_basis.h"

namespace elastogear::reduce_test {
namespace {

namespace fs = std::filesystem;

constexpr double kRoundoff = 1e-12;
constexpr double kEigensolver = 1e-9;

int rank_of(MPI_Comm comm) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  return rank;
}

mesh::Mesh example_mesh() {
  auto mesh = test::distorted(test::brick({5, 3, 2}, {1, 0.4, 0.2}), 0.02);
  mesh.cell_sets["rim"] = {4, 9, 14};
  return mesh;
}

reduction::ReductionOptions example_options() {
  reduction::ReductionOptions options;
  options.name = "bar";
  options.regions = {{"", test::kSteel}, {"rim", {3e9, 0.35, 1200}}};
  options.restrain = {"xmin"};
  options.surface = {"zmax", "ymin"};
  options.stress_nodes = {"xmax", "ymax"};
  options.markers = {"xmax", "xmin"};
  options.n_modes = 12;
  options.alpha = 3;
  options.beta = 1e-7;
  options.provenance = {{"option", "value"}};
  return options;
}

// A file of this test, another one for each number of ranks, and none at the start.
std::string output_path(const std::string& name) {
  int size = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  const fs::path path = fs::temp_directory_path() / ("reduce_" + name + std::to_string(size) + ".h5");
  if (rank_of(PETSC_COMM_WORLD) == 0) fs::remove(path);
  MPI_Barrier(PETSC_COMM_WORLD);
  return path.string();
}

// The mesh is on rank 0 only.
reduction::ReductionReport run(const mesh::Mesh& mesh, const reduction::ReductionOptions& options,
                               const std::string& output) {
  const mesh::Mesh none;
  return reduction::reduce(PETSC_COMM_WORLD, rank_of(PETSC_COMM_WORLD) == 0 ? mesh : none, options, output);
}

TEST(Reduce, writes_a_body_that_fits_its_own_modes) {
  const auto mesh = example_mesh();
  const auto options = example_options();
  const std::string output = output_path("modal");
  const auto report = run(mesh, options, output);
  EXPECT_LT(report.residual.maxCoeff(), 1e-6);
  if (rank_of(PETSC_COMM_WORLD) != 0) return;
  const auto body = io::read_body(output);
  const auto source = io::read_body_source(output);
  EXPECT_EQ(body.n_q(), 12);
  EXPECT_EQ(body.frequency, report.frequency);
  EXPECT_EQ(source.free_dof.size(), static_cast<std::size_t>(report.n_free));
  const auto S = fem::stress_operator(reduction::stressed_body(source), body.stress.node);
  for (int k = 0; k < 12; ++k) {
    const Eigen::VectorXd q = Eigen::VectorXd::Unit(12, k);
    const Eigen::Matrix3Xd u = io::read_displacement_field(output, q);
    const Eigen::VectorXd phi = u.reshaped();
    EXPECT_EQ(model::multiply(body.surface.Phi, q), u(Eigen::all, body.surface.node).reshaped());
    EXPECT_LT((model::multiply(body.stress.Psi, q) - S * phi).norm(), kRoundoff * (S * phi).norm());
    EXPECT_EQ(u(Eigen::all, mesh.node_sets.at("xmin")).norm(), 0);
    const Eigen::Vector3d mean = (reduction::marker_operator(mesh, {"xmax"}) * phi).head<3>();
    EXPECT_LT((model::displacement(body.markers[0].Phi, 0, q) - mean).norm(), kRoundoff * u.norm());
    EXPECT_EQ(model::multiply(body.markers[1].Phi, q).norm(), 0);  // on the restrained nodes
    EXPECT_NEAR(body.K_r.coeff(k, k), std::pow(2 * M_PI * body.frequency(k), 2), 1e-9 * body.K_r.coeff(k, k));
  }
}

TEST(Reduce, does_not_depend_on_the_number_of_ranks) {
  const auto mesh = example_mesh();
  const std::string output = output_path("ranks");
  run(mesh, example_options(), output);
  if (rank_of(PETSC_COMM_WORLD) != 0) return;
  const std::string serial = output + ".serial";
  reduction::reduce(PETSC_COMM_SELF, mesh, example_options(), serial);
  const auto a = io::read_body(output), b = io::read_body(serial);
  EXPECT_LT((a.frequency - b.frequency).cwiseQuotient(b.frequency).norm(), kEigensolver);
  // Vectors are as exact as the residual over the distance to the next eigenvalue.
  constexpr double kVector = 1e-6;
  EXPECT_LT((a.inertia.C_l - b.inertia.C_l).norm(), kVector * b.inertia.C_l.norm());
  const auto &Psi_a = std::get<model::DenseRows>(a.stress.Psi),
             &Psi_b = std::get<model::DenseRows>(b.stress.Psi);
  EXPECT_LT((Psi_a - Psi_b).norm(), kVector * Psi_b.norm());
}

Eigen::MatrixXd trace(const model::ElasticBody& body) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(body.n_q(), body.n_q());
  for (int i = 0; i < 3; ++i)
    model::with_rows(body.inertia.S_2[i], [&](const auto& S) { sum += Eigen::MatrixXd(S); });
  return sum;
}

TEST(Reduce, keeps_every_degree_of_freedom_in_the_full_basis) {
  const auto mesh = example_mesh();
  auto options = example_options();
  const std::string modal = output_path("of_full_modal"), full = output_path("full");
  run(mesh, options, modal);
  options.basis = model::Basis::full;
  run(mesh, options, full);
  if (rank_of(PETSC_COMM_WORLD) != 0) return;
  const auto a = io::read_body(full), b = io::read_body(modal);
  const auto source = io::read_body_source(full);
  EXPECT_EQ(a.n_q(), static_cast<Eigen::Index>(source.free_dof.size()));
  EXPECT_EQ(a.frequency.size(), 0);
  const Eigen::MatrixXd Phi = test::modes_in_full_basis(modal, full);
  const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(b.n_q(), b.n_q()), K_r = b.K_r;
  EXPECT_LT((Phi.transpose() * a.M_r * Phi - I).norm(), kEigensolver);
  EXPECT_LT((Phi.transpose() * a.K_r * Phi - K_r).norm(), kEigensolver * K_r.norm());
  EXPECT_LT((Phi.transpose() * a.inertia.C_r - b.inertia.C_r).norm(), kRoundoff * b.inertia.C_r.norm());
  EXPECT_LT((a.inertia.S_1 * Phi - b.inertia.S_1).norm(), kRoundoff * b.inertia.S_1.norm());
  const Eigen::VectorXd q = Eigen::VectorXd::Random(b.n_q()), u = model::multiply(b.stress.Psi, q);
  EXPECT_LT((model::multiply(a.stress.Psi, Phi * q) - u).norm(), kRoundoff * u.norm());
}

// S^ab of both bases, and their sum over a = b, which is the mass matrix.
TEST(Reduce, stores_the_same_second_moments_in_both_bases) {
  const auto mesh = example_mesh();
  auto options = example_options();
  options.invariants = reduction::Invariants::full;
  options.store = reduction::Store::all;
  const std::string modal = output_path("moments"), full = output_path("full_moments");
  run(mesh, options, modal);
  options.basis = model::Basis::full;
  run(mesh, options, full);
  if (rank_of(PETSC_COMM_WORLD) != 0) return;
  const auto a = io::read_body(full), b = io::read_body(modal);
  const Eigen::MatrixXd Phi = test::modes_in_full_basis(modal, full);
  ASSERT_EQ(a.inertia.S_2.size(), 6U);
  ASSERT_EQ(b.inertia.S_2.size(), 6U);
  for (int i = 0; i < 6; ++i) {
    const Eigen::MatrixXd S = std::get<model::SparseRows>(a.inertia.S_2[i]),
                          S_r = std::get<model::DenseRows>(b.inertia.S_2[i]);
    EXPECT_LT((Phi.transpose() * S * Phi - S_r).norm(), kRoundoff * S_r.norm()) << i;
  }
  EXPECT_LT((trace(a) - a.M_r.toDense()).norm(), kRoundoff * trace(a).norm());
  EXPECT_LT((trace(b) - b.M_r.toDense()).norm(), kEigensolver);
  EXPECT_FALSE(fs::exists(modal + ".shapes"));
}

// Norms do not depend on the basis within a pair of equal eigenvalues.
TEST(Reduce, finds_the_same_second_moments_in_one_sector_and_without_whole_fields) {
  const auto mesh = test::disc({5, 1, 3, 2});
  auto options = example_options();
  options.regions = test::kSteelBody;
  options.restrain = {"bottom"};
  options.surface = options.stress_nodes = options.markers = {};
  options.invariants = reduction::Invariants::full;
  options.store = reduction::Store::surface;
  const std::string sector = output_path("sector_moments"), whole = output_path("whole_moments");
  run(mesh, options, sector);
  options.symmetry = reduction::Symmetry::none;
  run(mesh, options, whole);
  if (rank_of(PETSC_COMM_WORLD) != 0) return;
  const auto a = io::read_body(sector), b = io::read_body(whole);
  for (int i = 0; i < 6; ++i) {
    const double norm = std::get<model::DenseRows>(b.inertia.S_2[i]).norm();
    EXPECT_NEAR(std::get<model::DenseRows>(a.inertia.S_2[i]).norm(), norm, kEigensolver * norm) << i;
  }
  EXPECT_LT((trace(a) - a.M_r.toDense()).norm(), kEigensolver);
}

TEST(Reduce, reports_mass_centre_inertia_and_stages) {
  const auto mesh = test::brick({4, 2, 2}, {2, 1, 0.5});
  auto options = example_options();
  options.regions = test::kSteelBody;
  const auto report = run(mesh, options, output_path("report"));
  if (rank_of(PETSC_COMM_WORLD) != 0) return;
  const double m = test::kSteel.rho;
  EXPECT_NEAR(report.m / m, 1, kRoundoff);
  EXPECT_LT((report.c - Eigen::Vector3d(1, 0.5, 0.25)).norm(), kRoundoff);
  EXPECT_NEAR(report.J(0, 0), m / 12 * 1.25, kRoundoff * m);
  EXPECT_NEAR(report.J(0, 1), 0, kRoundoff * m);
  EXPECT_EQ(report.n_dofs, 3 * mesh.n_nodes());
  EXPECT_EQ(report.n_free, 3 * (mesh.n_nodes() - 9));
  EXPECT_GE(report.balance, 1);
  EXPECT_FALSE(report.times.empty());
}

TEST(Reduce, finds_the_same_modes_in_one_sector_as_in_the_whole_body) {
  auto mesh = test::disc({5, 1, 3, 2});
  for (int i = 1; i <= 4; ++i) mesh.node_sets["top"].push_back(mesh.n_nodes() - i);
  auto options = example_options();
  options.regions = test::kSteelBody;
  options.restrain = {"bottom"};
  options.surface = {"surface"};
  options.stress_nodes = {"bottom"};
  options.markers = {"top"};
  const std::string sector = output_path("sector"), whole = output_path("whole");
  const auto with = run(mesh, options, sector);
  options.symmetry = reduction::Symmetry::none;
  const auto without = run(mesh, options, whole);
  if (rank_of(PETSC_COMM_WORLD) != 0) return;
  EXPECT_EQ(with.symmetry.find("5 sectors"), 0U) << with.symmetry;
  EXPECT_EQ(without.symmetry, "");
  const auto a = io::read_body(sector), b = io::read_body(whole);
  EXPECT_LT((a.frequency - b.frequency).cwiseQuotient(b.frequency).norm(), kEigensolver);
  // Within a pair of equal eigenvalues the basis is arbitrary, what all modes make together is not.
  const auto &Phi_a = std::get<model::DenseRows>(a.markers[0].Phi),
             &Phi_b = std::get<model::DenseRows>(b.markers[0].Phi);
  EXPECT_LT((Phi_a * Phi_a.transpose() - Phi_b * Phi_b.transpose()).norm(),
            kEigensolver * Phi_b.squaredNorm());
  const Eigen::Matrix3d C_a = a.inertia.C_r.transpose() * a.inertia.C_r,
                        C_b = b.inertia.C_r.transpose() * b.inertia.C_r;
  EXPECT_LT((C_a - C_b).norm(), kEigensolver * C_b.norm());
  for (const std::string name : {"captured_mass", "static_completeness"}) {
    const auto find = [&](const reduction::ReductionReport& report) {
      const auto found = std::find_if(report.checks.begin(), report.checks.end(),
                                      [&](const model::Check& check) { return check.name == name; });
      EXPECT_NE(found, report.checks.end()) << name;
      return found == report.checks.end() ? Eigen::MatrixXd() : Eigen::MatrixXd(found->value);
    };
    const Eigen::MatrixXd c_a = find(with), c_b = find(without);
    ASSERT_EQ(c_a.size(), c_b.size()) << name;
    EXPECT_LT((c_a - c_b).norm(), kEigensolver * c_b.norm()) << name;
  }
}

TEST(Reduce, reports_why_no_symmetry_was_found) {
  const auto report = run(example_mesh(), example_options(), output_path("asymmetric"));
  if (rank_of(PETSC_COMM_WORLD) != 0) return;
  EXPECT_EQ(report.symmetry.find("none: "), 0U) << report.symmetry;
}

// Every rank throws the same message, which names `part`, and no file is left.
void expect_error(const mesh::Mesh& mesh, const reduction::ReductionOptions& options,
                  const std::string& part) {
  const std::string output = output_path("error");
  std::string message;
  try {
    run(mesh, options, output);
  } catch (const Error& error) {
    message = error.what();
  }
  EXPECT_NE(message.find(part), std::string::npos) << "'" << message << "' should name " << part;
  if (rank_of(PETSC_COMM_WORLD) != 0) return;
  for (const auto& entry : fs::directory_iterator(fs::path(output).parent_path()))
    EXPECT_EQ(entry.path().string().find(output), std::string::npos) << entry.path();
}

TEST(Reduce, fails_on_all_ranks_with_the_same_error) {
  const auto mesh = example_mesh();
  const auto with = [](const std::function<void(reduction::ReductionOptions&)>& change) {
    auto options = example_options();
    change(options);
    return options;
  };
  expect_error(mesh, with([](auto& o) { o.restrain = {"bore"}; }), "bore");
  expect_error(mesh, with([](auto& o) { o.restrain = {}; }), "singular");
  expect_error(mesh, with([](auto& o) { o.surface = {"flanks"}; }), "flanks");
  expect_error(mesh, with([](auto& o) { o.stress_nodes = {"root"}; }), "root");
  expect_error(mesh, with([](auto& o) { o.n_modes = 181; }), "181");
  expect_error(mesh, with([](auto& o) { o.n_modes = 0; }), "modes = 0");
  expect_error(mesh, with([](auto& o) { o.regions = {}; }), "no material");
  expect_error(mesh, with([](auto& o) { o.regions[1].material.E = NAN; }), "rim");
  expect_error(mesh, with([](auto& o) { o.beta = -1; }), "beta");
  auto inverted = mesh;
  inverted.X.row(1) *= -1;
  expect_error(inverted, example_options(), "cell 0");
}

TEST(Reduce, into_a_folder_that_does_not_exist_is_an_error) {
  EXPECT_THROW(run(example_mesh(), example_options(), "/nowhere/at/all.h5"), Error);
}

}  // namespace
}  // namespace elastogear::reduce_test
