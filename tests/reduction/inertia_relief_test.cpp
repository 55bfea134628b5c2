// Static answers of bodies that nothing holds.
#include "reduction/static_response/inertia_relief.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "../fem/system.h"
#include "elastogear/io/body_file.h"
#include "elastogear/reduction/reduce.h"
#include "reduction/eigensolver/factorisation.h"

namespace elastogear::inertia_relief_test {
namespace {

constexpr double kSinglePrecision = 1e-6;  // of stored answers

bool is_root() {
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  return rank == 0;
}

// Own rows of one vector as a column, and back.
Eigen::MatrixXd own_rows(Vec v) {
  PetscInt n = 0;
  const PetscScalar* values = nullptr;
  check(VecGetLocalSize(v, &n));
  check(VecGetArrayRead(v, &values));
  const Eigen::MatrixXd rows = Eigen::Map<const Eigen::VectorXd>(values, n);
  check(VecRestoreArrayRead(v, &values));
  return rows;
}

void set_rows(Vec v, const Eigen::MatrixXd& rows) {
  PetscScalar* values = nullptr;
  check(VecGetArrayWrite(v, &values));
  std::copy(rows.reshaped().begin(), rows.reshaped().end(), values);
  check(VecRestoreArrayWrite(v, &values));
}

// P' K+ P f = Phi Lambda^-1 Phi' f with all elastic modes, for a force on one node.
TEST(InertiaRelief, answers_as_all_elastic_modes_do) {
  auto mesh = test::distorted(test::brick({2, 2, 2}, {1, 0.8, 0.6}), 0.05);
  mesh.X.colwise() += Eigen::Vector3d(0.7, -0.4, 2);
  const auto system = test::assemble(mesh, {});
  const Mat K = system.matrices.K, M = system.matrices.M;
  UniqueVec v;
  check(MatCreateVecs(K, v.out(), nullptr));
  const fem::VectorGather gather(v, system.rows);
  const auto rigid = reduction::find_rigid_modes(K, M, gather, mesh.X);
  Eigen::VectorXd f = Eigen::VectorXd::Zero(3 * mesh.n_nodes());
  f.segment<3>(3) << 1, -2, 3;
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(f.size());
  std::vector<Eigen::VectorXd> modes;
  const auto all = reduction::find_free_modes(
      K, M, rigid, {.n_modes = 3 * mesh.n_nodes() - 6, .window = reduction::kAutomaticWindow},
      [&](int, Vec phi) { modes.push_back(gather(phi)); });
  for (std::size_t i = 0; is_root() && i < modes.size(); ++i)
    expected += modes[i] * (modes[i].dot(f) / all.eigenvalue(static_cast<Eigen::Index>(i)));
  gather.scatter(f, v);
  Eigen::MatrixXd u = own_rows(v);
  const reduction::InertiaRelief relief(M, rigid);
  const UniqueMat grounded = relief.ground(K);
  reduction::ShiftedFactor factor(grounded, M);
  EXPECT_EQ(factor.factorise(0), 0) << "springs as many as rigid motions hold the body";
  relief.balance(u);
  factor.solve(u);
  relief.release(u);
  set_rows(v, u);
  const Eigen::VectorXd found = gather(v);
  if (!is_root()) return;
  EXPECT_LT((found - expected).norm(), 1e-10 * expected.norm());
}

// ---- a bar that nothing holds, forces on its ends

constexpr double kLength = 2, kWidth = 0.2;  // m
constexpr int kCells = 20;
const model::Material kMaterial{2e11, 0, 8000};

struct Bar {
  model::ElasticBody body;
  io::BodySource source;
  Eigen::MatrixXf G;  // of all loaded nodes, three columns each
};

Bar reduced_bar() {
  const auto mesh = test::brick({kCells, 2, 2}, {kLength, kWidth, kWidth});
  reduction::ReductionOptions o;
  o.name = "bar";
  o.regions = {{"", kMaterial}};
  o.floating = o.frame_at_center = o.flexibility = true;
  o.surface = {"surface"};
  o.loaded = {"xmin", "xmax"};
  o.stress_nodes = {"surface"};
  o.n_modes = 4;
  o.window = reduction::kAutomaticWindow;
  o.symmetry = reduction::Symmetry::none;
  int size = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  const std::string path =
      std::filesystem::temp_directory_path() / ("relieved_bar_" + std::to_string(size) + ".h5");
  reduction::reduce(PETSC_COMM_WORLD, is_root() ? mesh : mesh::Mesh(), o, path);
  if (!is_root()) return {};
  Bar bar{io::read_body(path), io::read_body_source(path), {}};
  const model::Flexibility& f = bar.body.flexibility;
  bar.G.resize(6 * static_cast<Eigen::Index>(f.stress.node.size()), 3 * f.surface.node.cols());
  for (int b = 0; b < f.surface.node.cols(); ++b)
    bar.G.middleCols<3>(3 * b) = io::read_stress_responses(path, b);
  std::filesystem::remove(path);
  return bar;
}

// Forces along x on the loaded nodes, of sum `left` and `right` on the ends, as of a uniform pressure.
Eigen::VectorXf end_forces(const Bar& bar, double left, double right) {
  const model::Flexibility& flexibility = bar.body.flexibility;
  Eigen::VectorXf f = Eigen::VectorXf::Zero(3 * static_cast<Eigen::Index>(flexibility.node.size()));
  for (std::size_t b = 0; b < flexibility.node.size(); ++b) {
    const Eigen::Vector3d X = bar.body.surface.X.col(flexibility.node[b]);
    double share = 1. / 16;  // of a corner of four faces
    for (int d : {1, 2}) share *= std::abs(X(d)) < 1e-9 ? 2 : 1;
    f(3 * static_cast<Eigen::Index>(b)) = static_cast<float>(share * (X.x() < 0 ? left : right));
  }
  return f;
}

// sigma_xx at all evaluation nodes against `expected`, of their distance from the left end; all else is zero.
void expect_stress(const Bar& bar, const Eigen::VectorXf& f, const std::function<double(double)>& expected) {
  const Eigen::VectorXf sigma = bar.G * f;
  const double largest = sigma.cwiseAbs().maxCoeff();
  for (std::size_t e = 0; e < bar.body.stress.node.size(); ++e) {
    const auto at = static_cast<Eigen::Index>(6 * e);
    const double x = bar.body.stress.X(0, static_cast<Eigen::Index>(e)) + kLength / 2;
    EXPECT_NEAR(sigma(at), expected(x), kSinglePrecision * largest) << x;
    EXPECT_LT(sigma.segment<5>(at + 1).norm(), kSinglePrecision * largest) << x;
  }
}

TEST(FreeBar, between_balanced_end_forces_is_uniformly_stressed) {
  const Bar bar = reduced_bar();
  if (!is_root()) return;
  const double A = kWidth * kWidth;
  expect_stress(bar, end_forces(bar, -1000, 1000), [&](double) { return 1000 / A; });
}

// sigma = - F/A (1 - x/L): what is behind a section is pushed through it. The end cells have the stress of
// their middle.
TEST(FreeBar, that_is_pushed_at_one_end_is_stressed_by_its_inertia) {
  const Bar bar = reduced_bar();
  if (!is_root()) return;
  const double A = kWidth * kWidth, F = 1000, h = kLength / kCells;
  const Eigen::VectorXf f = end_forces(bar, F, 0);
  expect_stress(bar, f,
                [&](double x) { return -F / A * (1 - std::clamp(x, h / 2, kLength - h / 2) / kLength); });
}

// u = F / (E A) (L/3 - x + x^2 / 2 L), whose mean is zero, up to what interpolation between nodes adds to it.
TEST(FreeBar, that_is_pushed_at_one_end_gives_way_without_moving_as_a_whole) {
  const Bar bar = reduced_bar();
  if (!is_root()) return;
  const double A = kWidth * kWidth, F = 1000, h = kLength / kCells, L = kLength;
  const model::Flexibility& flexibility = bar.body.flexibility;
  const Eigen::VectorXf f = end_forces(bar, F, 0);
  Eigen::VectorXf u = Eigen::VectorXf::Zero(3 * static_cast<Eigen::Index>(flexibility.node.size()));
  for (int b = 0; b < flexibility.surface.node.cols(); ++b)
    u += model::displacement_columns(flexibility, b) * f.segment<3>(3 * b);
  for (std::size_t a = 0; a < flexibility.node.size(); ++a) {
    const double x = bar.body.surface.X(0, flexibility.node[a]) + L / 2;
    const double expected = F / (kMaterial.E * A) * (L / 3 - h * h / (12 * L) - x + x * x / (2 * L));
    EXPECT_NEAR(u(3 * static_cast<Eigen::Index>(a)) / expected, 1, 10 * kSinglePrecision) << x;
  }
}

}  // namespace
}  // namespace elastogear::inertia_relief_test
