// How good a basis is: effective masses and static completeness, against dense algebra and their limits.
#include "reduction/checks.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "../fem/system.h"
#include "reduction/basis.h"
#include "reduction/job/surface.h"
#include "reduction/modes/effective_mass.h"

namespace elastogear::checks_test {
namespace {

constexpr double kEigensolver = 1e-8;  // relative
constexpr double kRoundoff = 1e-10;

bool is_root() {
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  return rank == 0;
}

// A distorted block held at x = 0 with all its modes from a dense solution, on rank 0.
struct Block {
  mesh::Mesh mesh = test::distorted(test::brick({3, 2, 2}, {1, 0.5, 0.4}), 0.02);
  test::System system = test::assemble(mesh, {"xmin"});
  UniqueVec layout;
  fem::MassMoments moments = fem::mass_moments(mesh, test::kSteelBody);
  Eigen::MatrixXd K = fem::gather_matrix(system.matrices.K, system.rows);
  Eigen::MatrixXd M = fem::gather_matrix(system.matrices.M, system.rows);
  std::vector<int> dofs = fem::free_dofs(fem::held_directions(mesh, {"xmin"}));

  fem::VectorGather gather() {
    check(MatCreateVecs(system.matrices.K, layout.out(), nullptr));
    return {layout, system.rows};
  }

  model::ElasticBody body(int n_modes) const {
    model::ElasticBody body;
    body.inertia = fem::rigid_inertia(mesh, moments);
    body.surface = reduction::make_surface(mesh, test::kSteelBody, {"zmax", "xmax"});
    if (!is_root()) return body;
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> eigen(K, M);
    reduction::allocate_modes(body, n_modes);
    const model::SparseRows no_stress(0, 3 * mesh.n_nodes());
    for (int k = 0; k < n_modes; ++k) {
      Eigen::VectorXd phi = Eigen::VectorXd::Zero(3 * mesh.n_nodes());
      phi(dofs) = eigen.eigenvectors().col(k);
      reduction::set_mode(body, k, reduction::mode_column(body, phi, moments, no_stress));
    }
    reduction::set_modal_matrices(body, eigen.eigenvalues().head(n_modes));
    return body;
  }
};

TEST(EffectiveMass, of_all_modes_sums_up_to_the_mobile_mass) {
  Block block;
  const int all = static_cast<int>(block.dofs.size());
  const auto body = block.body(all);
  const auto mobile =
      reduction::mobile_masses(block.system.matrices.M, block.gather(), block.moments, body.inertia.c);
  if (!is_root()) return;
  const Eigen::VectorXd sum = reduction::effective_masses(body.inertia).colwise().sum();
  const reduction::SixDirections whole = reduction::body_masses(body.inertia);
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(sum(i) / mobile(i), 1, kRoundoff) << i;
    EXPECT_LT(mobile(i), 0.999 * whole(i)) << i;  // restrained nodes carry mass
    EXPECT_GT(mobile(i), 0.5 * whole(i)) << i;
  }
}

TEST(EffectiveMass, of_rotations_is_taken_about_the_centre_of_mass) {
  Block block;
  auto moved = block.mesh;
  moved.X.colwise() += Eigen::Vector3d(3, -2, 5);
  const auto inertia = [](const mesh::Mesh& mesh) {
    const auto moments = fem::mass_moments(mesh, test::kSteelBody);
    model::ElasticBody body;
    body.inertia = fem::rigid_inertia(mesh, moments);
    reduction::allocate_modes(body, 1);
    Eigen::VectorXd phi(3 * mesh.n_nodes());
    for (int i = 0; i < phi.size(); ++i) phi(i) = std::sin(i);
    reduction::set_mode(body, 0,
                        reduction::mode_column(body, phi, moments, model::SparseRows(0, phi.size())));
    return body.inertia;
  };
  const auto a = inertia(block.mesh), b = inertia(moved);
  EXPECT_LT((reduction::effective_masses(a) - reduction::effective_masses(b)).norm(),
            kRoundoff * reduction::effective_masses(b).norm());
  EXPECT_LT((reduction::body_masses(a) - reduction::body_masses(b)).norm(),
            kRoundoff * reduction::body_masses(b).norm());
}

TEST(Completeness, of_all_modes_is_one_and_grows_with_their_number) {
  Block block;
  const auto gather = block.gather();
  const reduction::ElasticSystem system{block.system.matrices.K, block.system.matrices.M, gather};
  Eigen::VectorXd before = Eigen::VectorXd::Zero(4);
  const int all = static_cast<int>(block.dofs.size());
  for (int n : {1, 10, 40, all}) {
    const auto [load, share] = reduction::static_completeness(system, block.body(n), block.mesh.n_nodes());
    if (!is_root()) continue;
    ASSERT_EQ(load, (std::vector<std::string>{"xmax pressure", "xmax force", "zmax pressure", "zmax force"}));
    EXPECT_GE((share - before).minCoeff(), 0) << n;
    before = share;
  }
  if (!is_root()) return;
  EXPECT_LT((before.array() - 1).abs().maxCoeff(), kEigensolver);
}

TEST(Completeness, is_the_share_of_the_compliance) {
  Block block;
  const auto gather = block.gather();
  const auto body = block.body(7);
  const auto loads = reduction::representative_loads(body.surface);
  const auto [load, share] = reduction::static_completeness(
      {block.system.matrices.K, block.system.matrices.M, gather}, body, block.mesh.n_nodes());
  if (!is_root()) return;
  for (std::size_t j = 0; j < loads.size(); ++j) {
    Eigen::VectorXd whole = Eigen::VectorXd::Zero(3 * block.mesh.n_nodes());
    for (std::size_t i = 0; i < body.surface.node.size(); ++i)
      whole.segment<3>(3 * body.surface.node[i]) = loads[j].f.segment<3>(3 * i);
    const Eigen::VectorXd f = whole(block.dofs);
    const Eigen::VectorXd h = std::get<model::DenseRows>(body.surface.Phi).transpose() * loads[j].f;
    const double modal = (h.array().square() / Eigen::VectorXd(body.K_r.diagonal()).array()).sum();
    EXPECT_NEAR(share(j), modal / f.dot(block.K.ldlt().solve(f)), kEigensolver) << load[j];
  }
}

TEST(SurfaceLoads, push_inwards_with_the_area_of_a_group_and_with_one_newton) {
  const auto mesh = test::brick({4, 3, 2}, {1, 0.5, 0.4});
  for (const auto& load :
       reduction::representative_loads(reduction::make_surface(mesh, test::kSteelBody, {"zmax"}))) {
    const Eigen::Vector3d sum = load.f.reshaped(3, load.f.size() / 3).rowwise().sum();
    const double expected = load.name == "zmax pressure" ? 0.5 : 1;
    EXPECT_LT((sum - Eigen::Vector3d(0, 0, -expected)).norm(), kRoundoff) << load.name;
  }
}

TEST(SurfaceLoads, take_one_of_groups_that_differ_in_digits_only) {
  model::Surface surface;
  surface.X = test::brick({1, 1, 1}, {1, 1, 1}).X;
  surface.group_name = {"tooth_01_left", "tooth_01_right", "tooth_02_left", "tooth_02_right"};
  surface.group = {0, 1, 2, 3};
  surface.face.resize(4, 4);
  surface.face.colwise() = Eigen::Vector4i(0, 1, 3, 2);
  std::vector<std::string> names;
  for (const auto& load : reduction::representative_loads(surface)) names.push_back(load.name);
  EXPECT_EQ(names, (std::vector<std::string>{"tooth_01_left pressure", "tooth_01_left force",
                                             "tooth_01_right pressure", "tooth_01_right force"}));
}

}  // namespace
}  // namespace elastogear::checks_test
