#include "elastogear/model/corner_shares.h"

#include <gtest/gtest.h>

namespace elastogear::model::corner_shares_test {
namespace {

// Two quadrilaterals with midside nodes side by side, and a linear one.
Surface surface() {
  Surface surface;
  surface.X = Eigen::Matrix3Xd::Zero(3, 15);
  surface.face = Eigen::Matrix4Xi::Zero(4, 3);
  surface.side.resize(8, 3);
  surface.side.col(0) << 0, 1, 2, 3, 4, 5, 6, 7;
  surface.side.col(1) << 1, 8, 9, 2, 10, 11, 12, 5;
  surface.side.col(2).setConstant(-1);
  return surface;
}

TEST(CornerShares, are_halves_of_what_stands_between_corners) {
  const auto corners = corners_of_nodes(surface());
  ASSERT_EQ(corners.size(), 15);
  EXPECT_EQ(corners[0], (CornersOfNode{0, 0}));
  EXPECT_EQ(corners[4], (CornersOfNode{0, 1}));
  EXPECT_EQ(corners[7], (CornersOfNode{3, 0}));
  EXPECT_EQ(std::minmax(corners[5][0], corners[5][1]), std::minmax(1, 2));
  EXPECT_EQ(corners[13], (CornersOfNode{13, 13}));
  Eigen::RowVectorXd of_nodes = Eigen::RowVectorXd::Ones(15);
  const Eigen::MatrixXd sums = sums_at_corners(corners, of_nodes);
  EXPECT_EQ(sums(0, 0), 2);
  EXPECT_EQ(sums(0, 1), 2.5);
  EXPECT_EQ(sums(0, 4), 0);
  EXPECT_EQ(sums.sum(), 15);
}

// Consistent forces of an even pressure: -1/12 at corners, 1/3 at midside nodes of each side.
TEST(CornerShares, of_an_even_pressure_are_even) {
  const Surface two = surface();
  Eigen::RowVectorXd force = Eigen::RowVectorXd::Zero(15);
  for (int side : {0, 1})
    for (int i = 0; i < 8; ++i) force[two.side(i, side)] += i < 4 ? -1. / 12 : 1. / 3;
  const Eigen::MatrixXd sums = sums_at_corners(corners_of_nodes(two), force);
  for (int outer : {0, 3, 8, 9}) EXPECT_NEAR(sums(0, outer), 0.25, 1e-15);
  for (int shared : {1, 2}) EXPECT_NEAR(sums(0, shared), 0.5, 1e-15);
}

}  // namespace
}  // namespace elastogear::model::corner_shares_test
