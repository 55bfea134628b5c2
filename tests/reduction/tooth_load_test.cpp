// Stress at the root of a worm's thread under a static load on its flank, beside CalculiX.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <iostream>

#include "../fem/brick.h"
#include "../fem/system.h"
#include "../figures.h"
#include "calculix.h"
#include "elastogear/fem/stress.h"
#include "elastogear/gear/worm.h"
#include "elastogear/recovery/stress.h"

namespace elastogear::tooth_load_test {
namespace {

constexpr double kLoad = 1000;  // N
constexpr const char* kHeld = "seats";
constexpr double kHighlyStressed = 0.5;  // of the largest von Mises stress: what is compared
constexpr double kDigits = 1e-4;         // of the .frd file, relative
// Relative: our incompatible modes pass the patch test on any shape; where cells are no parallelepipeds
// CalculiX's answer differently.
constexpr double kTaperedCells = 0.06;

using Forces = std::map<int, Eigen::Vector3d>;

Eigen::Vector3d area(const mesh::Mesh& mesh, const mesh::Face& f) {
  return (mesh.X.col(f[2]) - mesh.X.col(f[0])).cross(mesh.X.col(f[3]) - mesh.X.col(f[1])) / 2;
}

// The load normal to the flank, spread over the faces around the one in the middle of their list.
Forces tooth_load(const mesh::Mesh& mesh) {
  constexpr double kPatch = 0.003;  // m, its radius
  const std::vector<mesh::Face>& flank = mesh::face_set(mesh, "thread_1_left");
  const Eigen::Vector3d middle = mesh.X.col(flank[flank.size() / 2][0]);
  Forces forces;
  Eigen::Vector3d total = Eigen::Vector3d::Zero();
  for (const mesh::Face& face : flank) {
    if ((mesh.X.col(face[0]) - middle).norm() > kPatch) continue;
    total += area(mesh, face);
    for (int node : face) forces.try_emplace(node, Eigen::Vector3d::Zero()).first->second -= area(mesh, face);
  }
  for (auto& [node, f] : forces) f *= kLoad / (4 * total.norm());
  return forces;
}

Eigen::VectorXd solve(const test::System& system, const Eigen::VectorXd& f) {
  UniqueVec y, x;
  check(MatCreateVecs(system.matrices.K, x.out(), y.out()));
  for (PetscInt row = 0; row < static_cast<PetscInt>(system.rows.node.size()); ++row) {
    check(VecSetBlockSize(y, 3));
    check(VecSetValuesBlocked(y, 1, &row, f.data() + 3 * system.rows.node[row], INSERT_VALUES));
  }
  check(VecAssemblyBegin(y));
  check(VecAssemblyEnd(y));
  UniqueKSP ksp;
  PC pc = nullptr;
  check(KSPCreate(PETSC_COMM_SELF, ksp.out()));
  check(KSPSetOperators(ksp, system.matrices.K, system.matrices.K));
  check(KSPSetType(ksp, KSPPREONLY));
  check(KSPGetPC(ksp, &pc));
  check(PCSetType(pc, PCCHOLESKY));
  check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  check(KSPSolve(ksp, y, x));
  return fem::VectorGather(x, system.rows)(x);
}

Eigen::MatrixXd our_stress(const mesh::Mesh& mesh, const Forces& forces, model::Element element) {
  const auto system = test::assemble(mesh, {kHeld}, PETSC_COMM_SELF, test::kSteelBody, {element});
  Eigen::VectorXd f = Eigen::VectorXd::Zero(3 * mesh.n_nodes());
  for (const auto& [node, value] : forces) f.segment<3>(3 * node) = value;
  return fem::nodal_stress({mesh, test::kSteelBody, element}, solve(system, f));
}

std::vector<double> von_mises_at(const std::vector<int>& nodes, const Eigen::MatrixXd& stress) {
  std::vector<double> values;
  for (int node : nodes) values.push_back(recovery::von_mises(recovery::StressVector(stress.col(node))));
  return values;
}

struct Case {
  const char* calculix_element;
  model::Element element;
  double tolerance;
};

// Largest relative deviation of our von Mises stress from CalculiX's at those nodes where it is high.
double largest_deviation(const mesh::Mesh& mesh, const Case& c, const std::vector<int>& nodes,
                         const Forces& forces) {
  const auto ours = von_mises_at(nodes, our_stress(mesh, forces, c.element));
  const auto theirs =
      von_mises_at(nodes, test::calculix_stress({mesh, test::kSteel, {kHeld}, c.calculix_element}, forces));
  const double highest = *std::max_element(theirs.begin(), theirs.end());
  double worst = 0;
  int compared = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (theirs[i] < kHighlyStressed * highest) continue;
    ++compared;
    worst = std::max(worst, std::abs(ours[i] / theirs[i] - 1));
  }
  EXPECT_GT(compared, 1);
  std::cout << c.calculix_element << ", " << mesh.n_nodes() << " nodes, " << compared << " of "
            << nodes.size() << " compared, up to " << highest << " Pa: largest deviation " << worst << "\n";
  return worst;
}

class ToothLoad : public testing::TestWithParam<Case> {};

TEST_P(ToothLoad, stresses_the_root_as_in_calculix) {
  if (!test::calculix_is_installed()) GTEST_SKIP() << "ccx is not installed";
  const mesh::Mesh mesh = gear::worm_mesh(gear::Design{}, gear::worm_counts(gear::Size::tiny));
  const Forces forces = tooth_load(mesh);
  ASSERT_GT(forces.size(), 3u);
  const auto& root = mesh::node_set(mesh, "root");
  test::figure(
      {"load on a tooth of the worm", std::string("stress at the root by ") + GetParam().calculix_element,
       GetParam().tolerance == kTaperedCells ? "%" : ""},
      largest_deviation(mesh, GetParam(), root, forces), GetParam().tolerance);
}

INSTANTIATE_TEST_SUITE_P(Elements, ToothLoad,
                         testing::Values(Case{"C3D8", model::Element::plain, kDigits},
                                         Case{"C3D8I", model::Element::incompatible, kTaperedCells}),
                         [](const auto& info) { return info.param.calculix_element; });

TEST(SkewBeam, of_incompatible_cells_is_stressed_as_in_calculix) {
  if (!test::calculix_is_installed()) GTEST_SKIP() << "ccx is not installed";
  const auto shear = [](const Eigen::Vector3d& X) -> Eigen::Vector3d {
    return {X.x() + 0.8 * X.z(), X.y() + 0.5 * X.z(), X.z()};
  };
  mesh::Mesh beam = test::mapped(test::brick({6, 2, 2}, {1, 0.2, 0.2}), shear);
  beam.node_sets[kHeld] = beam.node_sets.at("xmin");
  Forces forces;
  for (int node : beam.node_sets.at("xmax")) forces[node] = {0, 300, 1000};
  const Case incompatible{"C3D8I", model::Element::incompatible, kDigits};
  test::figure({"skew beam", "nodal stress"},
               largest_deviation(beam, incompatible, beam.node_sets.at("ymin"), forces), kDigits);
}

}  // namespace
}  // namespace elastogear::tooth_load_test
