// Matrices of other programs: our own ones written as they would write them, and CalculiX' own.
#include "elastogear/reduction/imported.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iomanip>
#include <random>

#include "../fem/other_cells.h"
#include "../fem/system.h"
#include "calculix.h"
#include "elastogear/base/error.h"
#include "elastogear/io/body_file.h"
#include "elastogear/reduction/reduce.h"

namespace {

using namespace elastogear;
namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr double kRoundoff = 1e-10;   // of text with 17 digits, through the eigensolver
constexpr double kVector = 1e-6;      // of eigenvectors: residual over distance of eigenvalues
constexpr double kSameMatrix = 1e-6;  // CalculiX writes 14 digits, and prints 8 of a frequency

int rank_of_world() {
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  return rank;
}
bool is_root() { return rank_of_world() == 0; }

// A path of this test, another one for each number of ranks.
std::string path_of(const std::string& name) {
  int size = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  return fs::temp_directory_path() / ("imported_" + std::to_string(size) + "_" + name);
}

mesh::Mesh block() { return test::distorted(test::brick({4, 3, 2}, {1, 0.5, 0.3}), 0.02); }

// A matrix with the displacement of each row: dof[i] = 3 node + direction.
struct Labelled {
  Eigen::SparseMatrix<double> A;
  std::vector<int> dof;
};

struct Writer {
  std::ofstream out;

  explicit Writer(const std::string& path) : out(path) { out << std::scientific << std::setprecision(16); }
};

enum class Half { lower, upper, both };

bool in_half(Half half, int i, int j) {
  return half == Half::both || (half == Half::lower ? i >= j : i <= j);
}

// "row column value", rows from 1.
void write_triplets(const std::string& path, const Labelled& m, Half half) {
  Writer file(path);
  for (int j = 0; j < m.A.cols(); ++j)
    for (Eigen::SparseMatrix<double>::InnerIterator e(m.A, j); e; ++e)
      if (in_half(half, static_cast<int>(e.row()), j))
        file.out << e.row() + 1 << " " << j + 1 << " " << e.value() << "\n";
}

void write_matrix_market(const std::string& path, const Labelled& m) {
  Writer file(path);
  file.out << "%%MatrixMarket matrix coordinate real general\n"
           << m.A.rows() << " " << m.A.cols() << " " << m.A.nonZeros() << "\n";
  for (int j = 0; j < m.A.cols(); ++j)
    for (Eigen::SparseMatrix<double>::InnerIterator e(m.A, j); e; ++e)
      file.out << e.row() + 1 << " " << j + 1 << " " << e.value() << "\n";
}

void write_dofs(const std::string& path, const std::vector<int>& dof) {
  Writer file(path);
  for (int i : dof) file.out << i / 3 + 1 << "." << i % 3 + 1 << "\n";
}

// The data lines of *MATRIX INPUT, which *MATRIX OUTPUT, FORMAT=MATRIX INPUT writes: row node number, degree
// of freedom, column node number, degree of freedom, entry; one half of a symmetric matrix (Abaqus Keywords
// Reference Guide, *MATRIX INPUT). Nodes are numbered 10, 20, ...; lines in any order.
void write_abaqus(const std::string& path, const Labelled& m, double unit) {
  std::vector<std::string> lines;
  for (int j = 0; j < m.A.cols(); ++j)
    for (Eigen::SparseMatrix<double>::InnerIterator e(m.A, j); e; ++e) {
      if (e.row() > j) continue;
      const int row = m.dof[e.row()], column = m.dof[j];
      std::ostringstream line;
      line << std::scientific << std::setprecision(16) << 10 * (row / 3 + 1) << "," << row % 3 + 1 << ", "
           << 10 * (column / 3 + 1) << "," << column % 3 + 1 << ", " << e.value() / unit;
      lines.push_back(line.str());
    }
  std::shuffle(lines.begin(), lines.end(), std::mt19937(3));
  Writer file(path);
  for (const auto& line : lines) file.out << line << "\n";
}

struct Files {
  Labelled K, M;
  reduction::ImportedFiles imported;
};

// K and M of the mesh without the rows of the held sets, as files.
Files our_matrices(const mesh::Mesh& mesh, const std::vector<std::string>& held) {
  const auto system = test::assemble(mesh, held, PETSC_COMM_SELF);
  const auto dof = fem::free_dofs(fem::held_directions(mesh, held));
  return {{fem::gather_matrix(system.matrices.K, system.rows), dof},
          {fem::gather_matrix(system.matrices.M, system.rows), dof},
          {path_of("k.txt"), path_of("m.txt")}};
}

reduction::ImportedSystem read(const mesh::Mesh& mesh, const reduction::ImportedFiles& files) {
  MPI_Barrier(PETSC_COMM_WORLD);
  return reduction::read_imported(PETSC_COMM_WORLD, is_root() ? mesh : mesh::Mesh{}, files);
}

void expect_equal(const reduction::ImportedSystem& read, const Files& files) {
  const Eigen::MatrixXd K = fem::gather_matrix(read.matrices.K, read.dof);
  const Eigen::MatrixXd M = fem::gather_matrix(read.matrices.M, read.dof);
  if (!is_root()) return;
  EXPECT_EQ(read.dof, files.K.dof);
  EXPECT_LT((K - Eigen::MatrixXd(files.K.A)).norm(), 1e-15 * K.norm());
  EXPECT_LT((M - Eigen::MatrixXd(files.M.A)).norm(), 1e-15 * M.norm());
}

TEST(ImportedMatrices, are_the_same_from_each_half_and_from_the_whole) {
  const auto mesh = block();
  Files files = our_matrices(mesh, {});
  for (Half half : {Half::lower, Half::upper, Half::both}) {
    if (is_root()) {
      write_triplets(files.imported.stiffness, files.K, half);
      write_triplets(files.imported.mass, files.M, half);
    }
    expect_equal(read(mesh, files.imported), files);
  }
  if (is_root()) write_matrix_market(files.imported.stiffness, files.K);
  expect_equal(read(mesh, files.imported), files);
}

TEST(ImportedMatrices, of_abaqus_are_read_by_node_numbers_in_its_units) {
  const auto mesh = block();
  Files files = our_matrices(mesh, {});
  for (int i = 1; i <= mesh.n_nodes(); ++i) files.imported.node_number.push_back(10 * i);
  files.imported.stiffness_unit = files.imported.mass_unit = 1000;  // N/mm, t
  if (is_root()) {
    write_abaqus(files.imported.stiffness, files.K, 1000);
    write_abaqus(files.imported.mass, files.M, 1000);
  }
  expect_equal(read(mesh, files.imported), files);
}

TEST(ImportedMatrices, leave_out_displacements_that_abaqus_holds) {
  const auto mesh = block();
  Files free = our_matrices(mesh, {"xmin"}), all = our_matrices(mesh, {});
  for (int node : mesh.node_sets.at("xmin"))
    for (int d = 0; d < 3; ++d) all.K.A.coeffRef(3 * node + d, 3 * node + d) = 1e36;
  for (int i = 1; i <= mesh.n_nodes(); ++i) all.imported.node_number.push_back(10 * i);
  if (is_root()) {
    write_abaqus(all.imported.stiffness, all.K, 1);
    write_abaqus(all.imported.mass, all.M, 1);
  }
  expect_equal(read(mesh, all.imported), free);
}

TEST(ImportedMass, has_the_moments_of_the_elements) {
  const auto mesh = block();
  Files files = our_matrices(mesh, {});
  if (is_root()) {
    write_triplets(files.imported.stiffness, files.K, Half::lower);
    write_triplets(files.imported.mass, files.M, Half::lower);
  }
  const auto system = read(mesh, files.imported);
  UniqueVec layout;
  check(MatCreateVecs(system.matrices.M, layout.out(), nullptr));
  const fem::VectorGather gather(layout, system.dof, 3 * mesh.n_nodes());
  const auto moments = reduction::mass_moments(system.matrices.M, gather, is_root() ? mesh : mesh::Mesh{});
  const auto expected = fem::mass_moments(mesh, test::kSteelBody);
  if (!is_root()) return;
  EXPECT_TRUE(reduction::is_complete(mesh, system.dof));
  EXPECT_LT((moments.w_0 - expected.w_0).norm(), 1e-13 * expected.w_0.norm());
  EXPECT_LT((moments.w_1 - expected.w_1).norm(), 1e-13 * expected.w_1.norm());
}

reduction::ReductionOptions options_of_block() {
  reduction::ReductionOptions options;
  options.name = "block";
  options.regions = test::kSteelBody;
  options.restrain = {"xmin"};
  options.surface = {"zmax"};
  options.stress_nodes = {"xmax"};
  options.n_modes = 12;
  return options;
}

// The body that `options` give, on rank 0.
model::ElasticBody reduced(const mesh::Mesh& mesh, const reduction::ReductionOptions& options,
                           const std::string& name) {
  MPI_Barrier(PETSC_COMM_WORLD);
  const std::string path = path_of(name + ".h5");
  reduction::reduce(PETSC_COMM_WORLD, is_root() ? mesh : mesh::Mesh{}, options, path);
  return is_root() ? io::read_body(path) : model::ElasticBody{};
}

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
  return std::visit([](const auto& r) { return Eigen::MatrixXd(r); }, rows);
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

TEST(ImportedMass, that_depends_on_the_direction_has_no_scalar_part) {
  const auto mesh = block();
  for (const auto& [row, column] : {std::pair(3, 3), std::pair(3, 4)}) {
    Files files = our_matrices(mesh, {});
    files.M.A.coeffRef(row, column) += 0.1 * files.M.A.coeff(row, row);
    if (row != column) files.M.A.coeffRef(column, row) = files.M.A.coeff(row, column);
    if (is_root()) {
      write_triplets(files.imported.stiffness, files.K, Half::lower);
      write_triplets(files.imported.mass, files.M, Half::lower);
    }
    const auto system = read(mesh, files.imported);
    EXPECT_THROW(reduction::scalar_mass(system, is_root() ? mesh.n_nodes() : 0), Error);
  }
}

// Without the x of some nodes and the y of others no entry tells what mass these share.
TEST(ImportedMass, of_nodes_without_a_common_direction_is_refused) {
  const auto mesh = block();
  Files files = our_matrices(mesh, {});
  const auto keep = [](int dof) { return dof / 3 > 1 || dof % 3 == dof / 3; };  // 0.x, 1.y, all others
  std::vector<int> kept;
  for (int dof = 0; dof < 3 * mesh.n_nodes(); ++dof)
    if (keep(dof)) kept.push_back(dof);
  for (Labelled* m : {&files.K, &files.M}) {
    m->A = Eigen::MatrixXd(Eigen::MatrixXd(m->A)(kept, kept)).sparseView();
    m->dof = kept;
  }
  files.imported.dofs = path_of("dofs.txt");
  if (is_root()) {
    write_triplets(files.imported.stiffness, files.K, Half::lower);
    write_triplets(files.imported.mass, files.M, Half::lower);
    write_dofs(files.imported.dofs, kept);
  }
  const auto system = read(mesh, files.imported);
  EXPECT_THROW(reduction::scalar_mass(system, is_root() ? mesh.n_nodes() : 0), Error);
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

// Every rank throws the same message, which names `part`.
void expect_error(const mesh::Mesh& mesh, const reduction::ReductionOptions& options,
                  const std::string& part) {
  std::string message;
  try {
    reduced(mesh, options, "error");
  } catch (const Error& error) {
    message = error.what();
  }
  EXPECT_THAT(message, HasSubstr(part));
}

TEST(ImportedBody, of_damaged_files_is_an_error_on_all_ranks) {
  const auto mesh = block();
  auto options = options_of_block();
  Files files = our_matrices(mesh, {});
  options.imported = files.imported;
  const auto with_stiffness = [&](const std::function<void(Labelled&)>& change, const std::string& part) {
    Labelled K = files.K;
    change(K);
    if (is_root()) write_triplets(files.imported.stiffness, K, Half::both);
    expect_error(mesh, options, part);
  };
  if (is_root()) write_triplets(files.imported.mass, files.M, Half::lower);
  with_stiffness([](auto& K) { K.A.coeffRef(3, 0) *= 1.01; }, "not symmetric");
  with_stiffness([](auto& K) { K.A.coeffRef(5, 5) = -1; }, "node 2, direction 3 has no positive entry");
  with_stiffness([](auto& K) { K.A.coeffRef(5, 5) = NAN; }, "nan");
  with_stiffness([](auto& K) { K.A.conservativeResize(90, 90); }, "complete?");
  with_stiffness([](auto& K) { K.A.conservativeResize(200, 200), K.A.coeffRef(199, 199) = 1; },
                 "row 200 of 180");
  with_stiffness([](auto& K) { K.A.coeffRef(100, 100) *= 1e-3; },
                 "k.txt: the matrix is not positive definite");
  if (is_root()) {
    Labelled M = files.M;
    M.A.coeffRef(90, 93) = M.A.coeffRef(93, 90) = 10 * M.A.coeff(90, 90);
    write_triplets(files.imported.mass, M, Half::lower);
  }
  options.restrain = {"xmax"};
  expect_error(mesh, options, "m.txt: the matrix is not positive definite");
  options.imported->mass = "/nowhere.txt";
  expect_error(mesh, options, "/nowhere.txt");
}

TEST(ImportedBody, without_restraint_is_an_error_that_offers_a_free_body) {
  const auto mesh = block();
  auto options = options_of_block();
  Files files = our_matrices(mesh, {});
  if (is_root()) {
    write_triplets(files.imported.stiffness, files.K, Half::lower);
    write_triplets(files.imported.mass, files.M, Half::lower);
  }
  options.imported = files.imported;
  options.restrain = {};
  expect_error(mesh, options, "restrain");
  options.floating = true;
  mesh::Mesh moved = mesh;
  moved.X.row(0) += 0.3 * mesh.X.row(1).cwiseAbs2();
  expect_error(moved, options, "coordinates");
}

}  // namespace
