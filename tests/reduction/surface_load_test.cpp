// Loads that vary slowly over areas of a surface.
#include "elastogear/reduction/surface_load.h"

#include <gtest/gtest.h>

#include "../fem/brick.h"
#include "elastogear/base/error.h"
#include "reduction/job/surface.h"

namespace elastogear::surface_load_test {
namespace {

using Eigen::Vector3d;

constexpr double kRoundoff = 1e-14;

model::Surface two_sides() {
  return reduction::make_surface(test::brick({3, 4, 2}, {1, 0.4, 0.25}), test::kSteelBody, {"xmax", "zmax"});
}

Vector3d resultant(const Eigen::MatrixXd& loads, Eigen::Index column) {
  return loads.col(column).reshaped(3, loads.rows() / 3).rowwise().sum();
}

TEST(SmoothLoads, have_the_resultants_of_pressure_and_traction_on_each_area) {
  const Eigen::MatrixXd loads = reduction::smooth_loads(two_sides(), 14);
  ASSERT_EQ(loads.cols(), 14);  // xmax and zmax by turns
  const double A_x = 0.4 * 0.25, A_z = 1 * 0.4;
  EXPECT_LT((resultant(loads, 0) + A_x * Vector3d::UnitX()).norm(), kRoundoff);
  EXPECT_LT((resultant(loads, 1) + A_z * Vector3d::UnitZ()).norm(), kRoundoff);
  for (int d = 0; d < 3; ++d) {
    EXPECT_LT((resultant(loads, 2 + 2 * d) - A_x * Vector3d::Unit(d)).norm(), kRoundoff) << d;
    EXPECT_LT((resultant(loads, 3 + 2 * d) - A_z * Vector3d::Unit(d)).norm(), kRoundoff) << d;
    EXPECT_LT(resultant(loads, 8 + 2 * d).norm(), kRoundoff) << d;
    EXPECT_LT(resultant(loads, 9 + 2 * d).norm(), kRoundoff) << d;
  }
}

// The pressure y - y_c on xmax, of width b and height h, does the work -b^3 h / 12 on the field (y - y_c)
// e_x.
TEST(SmoothLoads, of_the_last_kind_grow_from_the_centre) {
  const model::Surface surface = two_sides();
  const Eigen::MatrixXd loads = reduction::smooth_loads(surface, 14);
  Eigen::Matrix3Xd u = Eigen::Matrix3Xd::Zero(3, surface.X.cols());
  u.row(0) = surface.X.row(1).array() - 0.2;
  // The load is lumped: the trapezoidal rule on cells of width d is b h d^2 / 6 above the integral of y^2.
  const double b = 0.4, h = 0.25, d = 0.1;
  EXPECT_NEAR(loads.col(10).dot(u.reshaped()), -b * b * b * h / 12 - b * h * d * d / 6, kRoundoff);
  EXPECT_NEAR(loads.col(8).norm(), 0, kRoundoff);  // nothing grows along its own normal
}

TEST(SmoothLoads, leave_out_whole_kinds_that_find_no_room) {
  EXPECT_EQ(reduction::smooth_loads(two_sides(), 13).cols(), 8);
  EXPECT_EQ(reduction::smooth_loads(two_sides(), 7).cols(), 2);
  EXPECT_THROW(reduction::smooth_loads(two_sides(), 1), Error);
}

}  // namespace
}  // namespace elastogear::surface_load_test
