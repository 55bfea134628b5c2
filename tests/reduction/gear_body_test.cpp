// Rigid-body facts of our own worm and wheel.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "../fem/enclosed_inertia.h"
#include "../fem/system.h"
#include "elastogear/fem/inertia.h"
#include "elastogear/gear/wheel.h"
#include "elastogear/gear/worm.h"

namespace elastogear::gear_body_test {
namespace {

constexpr double kRoundoff = 1e-11;  // of sums over thousands of cells, relative

class GearBody : public testing::TestWithParam<bool> {
 protected:
  mesh::Mesh mesh() const {
    const gear::Design design;
    return GetParam() ? gear::worm_mesh(design, gear::worm_counts(gear::Size::tiny))
                      : gear::wheel_mesh(design, gear::wheel_counts(gear::Size::tiny));
  }
};

TEST_P(GearBody, has_mass_centre_and_inertia_of_the_enclosed_volume) {
  const auto m = mesh();
  const auto inertia = fem::rigid_inertia(m, fem::mass_moments(m, test::kSteelBody));
  const auto expected = test::enclosed_inertia(m, test::kSteel.rho);
  const double size = m.X.colwise().norm().maxCoeff();
  EXPECT_NEAR(inertia.m / expected.m, 1, kRoundoff);
  EXPECT_LT((inertia.c - expected.c).norm(), kRoundoff * size);
  EXPECT_LT((inertia.J - expected.J).norm(), kRoundoff * expected.J.norm());
}

TEST_P(GearBody, has_a_stiffness_that_annihilates_the_six_rigid_modes) {
  const auto m = mesh();
  const auto system = test::assemble(m, {}, PETSC_COMM_SELF);
  UniqueVec u, f;
  check(MatCreateVecs(system.matrices.K, u.out(), f.out()));
  double norm_K = 0, norm_u = 0, norm_f = 0;
  check(MatNorm(system.matrices.K, NORM_FROBENIUS, &norm_K));
  for (int mode = 0; mode < 6; ++mode) {
    for (int row = 0; row < m.n_nodes(); ++row) {
      const Eigen::Vector3d axis = Eigen::Vector3d::Unit(mode % 3);
      const Eigen::Vector3d value = mode < 3 ? axis : axis.cross(m.X.col(system.rows.node[row]));
      const PetscInt index = row;
      check(VecSetBlockSize(u, 3));
      check(VecSetValuesBlocked(u, 1, &index, value.data(), INSERT_VALUES));
    }
    check(VecAssemblyBegin(u));
    check(VecAssemblyEnd(u));
    check(MatMult(system.matrices.K, u, f));
    check(VecNorm(u, NORM_2, &norm_u));
    check(VecNorm(f, NORM_2, &norm_f));
    EXPECT_LT(norm_f, kRoundoff * norm_K * norm_u) << "mode " << mode;
  }
}

INSTANTIATE_TEST_SUITE_P(WormAndWheel, GearBody, testing::Values(true, false),
                         [](const auto& test) { return test.param ? "worm" : "wheel"; });

}  // namespace
}  // namespace elastogear::gear_body_test
