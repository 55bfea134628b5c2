// Bodies from matrices of other programs: our own ones written as they would write them, and CalculiX' own.
#include <gtest/gtest.h>

#include "calculix.h"
#include "imported_files.h"

namespace elastogear::imported_body_test {
namespace {

using namespace test;

constexpr double kRoundoff = 1e-10;   // of text with 17 digits, through the eigensolver
constexpr double kVector = 1e-6;      // of eigenvectors: residual over distance of eigenvalues
constexpr double kSameMatrix = 1e-6;  // CalculiX writes 14 digits, and prints 8 of a frequency

void expect_same_body(const model::ElasticBody& a, const model::ElasticBody& b) {
  if (!is_root()) return;
  EXPECT_LT((a.frequency - b.frequency).cwiseQuotient(b.frequency).cwiseAbs().maxCoeff(), kRoundoff);
  EXPECT_NEAR(a.inertia.m / b.inertia.m, 1, kRoundoff);
  EXPECT_LT((a.inertia.J - b.inertia.J).norm(), kRoundoff * b.inertia.J.norm());
  EXPECT_LT((a.inertia.C_l - b.inertia.C_l).norm(), kVector * b.inertia.C_l.norm());
  EXPECT_LT((a.inertia.S_1 - b.inertia.S_1).norm(), kVector * b.inertia.S_1.norm());
  const auto rows = [](const model::BasisRows& r) { return std::get<model::DenseRows>(r); };
  EXPECT_LT((rows(a.surface.Phi) - rows(b.surface.Phi)).norm(), kVector * rows(b.surface.Phi).norm());
  EXPECT_LT((rows(a.stress.Psi) - rows(b.stress.Psi)).norm(), kVector * rows(b.stress.Psi).norm());
}

TEST(ImportedBody, of_our_own_matrices_is_our_own_body) {
  const auto mesh = block();
  auto options = options_of_block();
  const auto own = reduced(mesh, options, "own");
  Files whole = our_matrices(mesh, {}), held = our_matrices(mesh, {"xmin"});
  if (is_root()) {
    write_triplets(whole.imported.stiffness, whole.K, Half::lower);
    write_triplets(whole.imported.mass, whole.M, Half::lower);
  }
  options.imported = whole.imported;  // restrained here, inertia from M
  expect_same_body(reduced(mesh, options, "whole"), own);
  held.imported.dofs = path_of("dofs.txt");
  if (is_root()) {
    write_triplets(held.imported.stiffness, held.K, Half::upper);
    write_triplets(held.imported.mass, held.M, Half::upper);
    write_dofs(held.imported.dofs, held.K.dof);
  }
  options.imported = held.imported;  // restrained there, inertia from the mesh
  options.restrain = {};
  expect_same_body(reduced(mesh, options, "held"), own);
}

TEST(ImportedBody, may_be_held_in_single_directions) {
  const auto mesh = block();
  auto options = options_of_block();
  options.restrain = {"xmin:x", "ymin:yz", "zmin:z"};
  const auto own = reduced(mesh, options, "own_single");
  Files whole = our_matrices(mesh, {});
  if (is_root()) {
    write_triplets(whole.imported.stiffness, whole.K, Half::lower);
    write_triplets(whole.imported.mass, whole.M, Half::lower);
  }
  options.imported = whole.imported;
  expect_same_body(reduced(mesh, options, "whole_single"), own);
}

TEST(ImportedBody, may_be_free_and_needs_no_cells) {
  const auto mesh = block();
  auto options = options_of_block();
  options.restrain = options.surface = options.stress_nodes = {};
  options.floating = options.frame_at_center = true;
  const auto own = reduced(mesh, options, "own_free");
  Files files = our_matrices(mesh, {});
  if (is_root()) {
    write_triplets(files.imported.stiffness, files.K, Half::lower);
    write_triplets(files.imported.mass, files.M, Half::lower);
  }
  options.imported = files.imported;
  options.regions = {};
  mesh::Mesh nodes;
  nodes.X = mesh.X;
  const auto imported = reduced(nodes, options, "free");
  if (!is_root()) return;
  EXPECT_LT((imported.frequency - own.frequency).norm(), 1e-9 * own.frequency.norm());
  EXPECT_LT((imported.inertia.J - own.inertia.J).norm(), kRoundoff * own.inertia.J.norm());
  EXPECT_LT(imported.inertia.C_r.norm(), 1e-9 * std::sqrt(own.inertia.J.trace()));
  EXPECT_TRUE(own.assembled_K && own.assembled_M);
  EXPECT_FALSE(imported.assembled_K || imported.assembled_M);
}

TEST(ImportedBody, keeps_every_displacement_in_the_full_basis) {
  const auto mesh = block();
  auto options = options_of_block();
  options.basis = model::Basis::full;
  const auto own = reduced(mesh, options, "own_full");
  Files files = our_matrices(mesh, {});
  if (is_root()) {
    write_triplets(files.imported.stiffness, files.K, Half::lower);
    write_triplets(files.imported.mass, files.M, Half::lower);
  }
  options.imported = files.imported;
  const auto imported = reduced(mesh, options, "full");
  if (!is_root()) return;
  EXPECT_LT((imported.K_r - own.K_r).norm(), 1e-14 * own.K_r.norm());
  EXPECT_LT((imported.inertia.C_r - own.inertia.C_r).norm(), kRoundoff * own.inertia.C_r.norm());
}

// Held and free, as from our own matrices.
TEST(ImportedBody, has_the_static_answers_of_its_stiffness) {
  const auto mesh = block();
  Files files = our_matrices(mesh, {});
  if (is_root()) {
    write_triplets(files.imported.stiffness, files.K, Half::lower);
    write_triplets(files.imported.mass, files.M, Half::lower);
  }
  for (bool floating : {false, true}) {
    auto options = options_of_block();
    options.flexibility = true;
    if (floating) options.restrain = {};
    options.floating = options.frame_at_center = floating;
    const auto own = reduced(mesh, options, "own_responses");
    options.imported = files.imported;
    const auto imported = reduced(mesh, options, "answers");
    if (!is_root()) continue;
    ASSERT_EQ(imported.flexibility.node, own.flexibility.node);
    for (int b = 0; b < own.flexibility.surface.node.cols(); ++b) {
      const Eigen::MatrixXf F = model::displacement_columns(own.flexibility, b);
      EXPECT_LE((model::displacement_columns(imported.flexibility, b) - F).norm(), kVector * F.norm()) << b;
    }
  }
}

using Moments = std::vector<model::BasisRows>;

Eigen::MatrixXd dense(const model::BasisRows& rows) {
  return model::with_rows(rows, [](const auto& r) { return Eigen::MatrixXd(r); });
}

void expect_same_moments(const Moments& a, const Moments& b, double tolerance) {
  if (!is_root()) return;
  ASSERT_EQ(a.size(), 6u);
  ASSERT_EQ(b.size(), 6u);
  for (int i = 0; i < 6; ++i)
    EXPECT_LT((dense(a[i]) - dense(b[i])).norm(), tolerance * dense(b[i]).norm()) << i;
}

// S_2 follows from M and the nodes: held here, held by the other program, free; with a point mass.
TEST(ImportedBody, has_the_full_invariants_of_its_mass_matrix) {
  const auto mesh = block();
  auto options = options_of_block();
  options.invariants = reduction::Invariants::full;
  options.point_mass = {{"xmax", 20}};
  Files whole = our_matrices(mesh, {}), held = our_matrices(mesh, {"xmin"});
  held.imported = {path_of("k_held.txt"), path_of("m_held.txt"), path_of("dofs.txt")};
  if (is_root())
    for (const Files* files : {&whole, &held}) {
      write_triplets(files->imported.stiffness, files->K, Half::lower);
      write_triplets(files->imported.mass, files->M, Half::lower);
    }
  if (is_root()) write_dofs(held.imported.dofs, held.K.dof);
  for (model::Basis basis : {model::Basis::full, model::Basis::modal}) {
    const double tolerance = basis == model::Basis::full ? 1e-14 : kVector;
    options.basis = basis;
    options.restrain = {"xmin"};
    options.imported = {};
    const Moments own = reduced(mesh, options, "own_moments").inertia.S_2;
    options.imported = whole.imported;
    expect_same_moments(reduced(mesh, options, "whole_moments").inertia.S_2, own, tolerance);
    options.imported = held.imported;
    options.restrain = {};
    expect_same_moments(reduced(mesh, options, "held_moments").inertia.S_2, own, tolerance);
  }
}

// CalculiX' own frequencies from its own matrices; in mm, t, s.
void compare_with_calculix(mesh::CellType type, const std::string& element) {
  if (!test::calculix_is_installed()) GTEST_SKIP() << "ccx is not installed";
  const auto mesh = test::cells_of(type, test::distorted(test::brick({5, 2, 2}, {1, 0.3, 0.2}), 0.01));
  constexpr int n = 15;
  std::vector<double> expected(n, 0);
  std::unique_ptr<test::CalculixMatrices> matrices;
  reduction::ImportedFiles files;
  if (is_root()) {
    auto in_mm = mesh;
    in_mm.X *= 1000;
    const test::CalculixModel model{in_mm, {210e3, 0.3, 7.85e-9}, {"xmin"}, element};
    expected = test::calculix_frequencies(model, n);
    matrices = std::make_unique<test::CalculixMatrices>(model);
    files = {matrices->stiffness(), matrices->mass(), matrices->dofs()};
  }
  files.stiffness_unit = files.mass_unit = 1000;
  auto options = options_of_block();
  options.restrain = options.stress_nodes = {};
  options.surface = {"surface"};
  options.n_modes = n;
  options.imported = files;
  const auto body = reduced(mesh, options, "calculix");
  double worst = 0;
  for (int i = 0; is_root() && i < n; ++i)
    worst = std::max(worst, std::abs(body.frequency(i) / expected[i] - 1));
  EXPECT_LT(worst, kSameMatrix);
  if (is_root()) std::cout << element << ": largest deviation " << worst << "\n";
}

TEST(ImportedBody, of_calculix_has_its_frequencies) {
  compare_with_calculix(mesh::CellType::hex20, "C3D20");
  compare_with_calculix(mesh::CellType::hex8, "C3D8");
}

}  // namespace
}  // namespace elastogear::imported_body_test
