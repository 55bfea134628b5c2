#include "elastogear/evaluation/face_stations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "elastogear/base/rotation.h"
#include "elastogear/evaluation/contact.h"
#include "elastogear/evaluation/evaluate.h"
#include "evaluation/load/line_load.h"
#include "rigid_drives.h"

namespace elastogear::evaluation::face_stations_test {
namespace {

constexpr double kMean = 250e3;  // N/m

// Spur gears of these widths (m) with cells of 5 mm; the second one stands `offset` along the axis.
test::RollingPair gears(double first, double second, double offset) {
  test::RollingPair pair = test::spur_pair();
  const double width[] = {first, second};
  for (std::size_t g : {0, 1}) {
    pair.gear[g].width = width[g];
    const auto cells = static_cast<Eigen::Index>(std::lround(width[g] / 5e-3));
    pair.gear[g].layers = Eigen::VectorXd::LinSpaced(cells + 1, -width[g] / 2, width[g] / 2);
  }
  for (Eigen::Vector3d& x : pair.gear[1].position) x[2] += offset;
  return pair;
}

// Places along the second gear's axis where layers of the first one are and the common face ends.
Eigen::VectorXd places_of_contact(const test::RollingPair& pair, double offset) {
  const double half[] = {pair.gear[0].width / 2, pair.gear[1].width / 2};
  const double begin = std::max(-half[0] - offset, -half[1]), end = std::min(half[0] - offset, half[1]);
  std::vector<double> z = {begin, end};
  for (double layer : pair.gear[0].layers)
    if (layer - offset > begin && layer - offset < end) z.push_back(layer - offset);
  std::sort(z.begin(), z.end());
  return Eigen::Map<Eigen::VectorXd>(z.data(), static_cast<Eigen::Index>(z.size()));
}

// Consistent forces (N) of an even load at places between which displacements are linear.
Eigen::VectorXd even_forces(const Eigen::VectorXd& z) { return kMean * at_layers(z).widths(); }

TEST(Stations, show_an_even_load_on_the_common_face_as_even) {
  for (double first : {20e-3, 20.5e-3, 22e-3, 24e-3, 27e-3, 18e-3})
    for (double offset : {0.0, 2.5e-10, -2.5e-10, 1e-3, -3.1e-3}) {
      const test::RollingPair pair = gears(first, 20e-3, offset);
      const Eigen::VectorXd z = places_of_contact(pair, offset);
      const FaceStations at = stations(pair.both(), 0, 0, 1);
      const Eigen::VectorXd w = line_load(at, z, even_forces(z));
      EXPECT_LT((w.array() / kMean - 1).abs().maxCoeff(), 1e-9) << first << ' ' << offset << '\n' << w;
      EXPECT_NEAR(at.z[0], z[0], 1e-15);
      EXPECT_NEAR(at.z[at.n() - 1], z[z.size() - 1], 1e-15);
      EXPECT_GE(at.n(), 4);
    }
}

TEST(CommonWidth, is_where_both_faces_stand_beside_each_other_as_mounted) {
  PairOfRun pair;
  pair.gear[0].width = 15e-3, pair.gear[1].width = 12e-3;
  pair.gear[1].origin = {0.1, 0, 1e-3};
  EXPECT_DOUBLE_EQ(common_width(pair), 12e-3);
  pair.gear[1].origin[2] = -5e-3;
  EXPECT_DOUBLE_EQ(common_width(pair), 8.5e-3);
  pair.gear[1].R = rotation_matrix(Eigen::Vector3d(1, 0, 0));
  EXPECT_DOUBLE_EQ(common_width(pair), 12e-3);
}

TEST(Stations, along_either_axis_are_the_same_places) {
  test::RollingPair pair = gears(22e-3, 20e-3, 1e-3);
  for (int slave : {0, 1})
    for (int strips : {0, 16}) {
      const FaceStations first = stations(pair.both(), slave, strips, 0),
                         second = stations(pair.both(), slave, strips, 1);
      ASSERT_EQ(first.n(), second.n());
      EXPECT_LT((first.z.array() - 1e-3 - second.z.array()).abs().maxCoeff(), 1e-15);
      EXPECT_LT((first.ends.array() - 1e-3 - second.ends.array()).abs().maxCoeff(), 1e-15);
    }
}

TEST(Stations, of_gears_that_look_against_each_other_ascend) {
  test::RollingPair pair = gears(22e-3, 20e-3, 1e-3);
  pair.gear[0].R = pair.gear[0].R * Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX());
  const Eigen::VectorXd at = stations(pair.both(), 0, 0, 1).z;
  for (Eigen::Index i = 0; i + 1 < at.size(); ++i) EXPECT_LT(at[i], at[i + 1]);
  EXPECT_NEAR(at[0], -10e-3, 1e-15);
}

// One side of 20-node hexahedra after the other along the face, whose midside nodes take most of the load.
model::Surface quadratic_flank(int cells) {
  model::Surface surface;
  surface.X = Eigen::Matrix3Xd::Zero(3, 0);
  surface.face.resize(4, cells);
  surface.side.resize(8, cells);
  const auto node = [&](double x, double z) {
    surface.X.conservativeResize(3, surface.X.cols() + 1);
    surface.X.rightCols<1>() = Eigen::Vector3d(x, 0, z);
    return static_cast<int>(surface.X.cols()) - 1;
  };
  for (int c = 0; c < cells; ++c) {
    const double x[] = {0, 1, 1, 0, 0.5, 1, 0.5, 0}, z[] = {0, 0, 1, 1, 0, 0.5, 1, 0.5};
    for (int i = 0; i < 8; ++i) surface.side(i, c) = node(0.024 + 1e-3 * x[i], 5e-3 * (c + z[i]));
    surface.face.col(c) = surface.side.col(c).tail<4>();
    surface.group.push_back(0);
  }
  surface.group_name = {"tooth_03_left"};
  return surface;
}

TEST(NodeLayers, of_second_order_are_those_of_corners) {
  const model::Surface surface = quadratic_flank(4);
  const Eigen::VectorXd z = node_layers(flanks(test::spur_pair().gear[0].toothing, surface));
  ASSERT_EQ(z.size(), 5);
  EXPECT_LT((z - Eigen::VectorXd::LinSpaced(5, 0, 20e-3)).cwiseAbs().maxCoeff(), 1e-12);
}

// Whatever share the midside layers have: consistent forces of the side (2/3), or those of faces through its
// nodes.
TEST(Stations, show_an_even_load_on_sides_of_second_order_as_even) {
  test::RollingPair pair = gears(20e-3, 20e-3, 0);
  const model::Surface surface = quadratic_flank(4);
  pair.gear[0].layers = node_layers(flanks(pair.gear[0].toothing, surface)).array() - 10e-3;
  const Eigen::VectorXd z = Eigen::VectorXd::LinSpaced(9, -10e-3, 10e-3);
  const FaceStations at = stations(pair.both(), 0, 0, 1);
  for (double midside : {2. / 3, 0.87}) {
    Eigen::VectorXd force(9);
    for (Eigen::Index i = 0; i < 9; ++i)
      force[i] = kMean * 5e-3 * (i % 2 == 1 ? midside : (1 - midside) * (i == 0 || i == 8 ? 0.5 : 1));
    const Eigen::VectorXd w = line_load(at, z, force);
    EXPECT_LT((w.array() / kMean - 1).abs().maxCoeff(), 1e-9) << w;
  }
}

TEST(ShareOut, keeps_sum_and_moment_and_ends_what_lies_beyond) {
  const FaceStations at = at_layers((Eigen::VectorXd(4) << -0.02, -0.01, 0, 0.02).finished());
  const StationShare inside = share_out(at, 0.005);
  EXPECT_EQ(inside.station, (std::array<Eigen::Index, 2>{2, 3}));
  EXPECT_NEAR(inside.share[0] + inside.share[1], 1, 1e-15);
  EXPECT_NEAR(inside.share[0] * at.z[2] + inside.share[1] * at.z[3], 0.005, 1e-15);
  EXPECT_EQ(share_out(at, 0.03).share[1], 1);
  EXPECT_EQ(share_out(at, -0.03).share[0], 1);
  EXPECT_EQ(at.ends, (Eigen::VectorXd(5) << -0.02, -0.015, -0.005, 0.01, 0.02).finished());
}

// Layers that lie unevenly among strips took up to a tenth more or less of an even load.
TEST(Stations, show_an_even_load_on_strips_as_even) {
  for (double offset : {0.0, 2.5e-10, 1e-3}) {
    const test::RollingPair pair = gears(22e-3, 20e-3, offset);
    const FaceStations at = stations(pair.both(), 0, 16, 1);
    ASSERT_EQ(at.n(), 16);
    EXPECT_NEAR(at.widths().sum(), 20e-3, 1e-12 + offset);
    const Eigen::VectorXd w = line_load(at, at.z, kMean * at.widths());
    EXPECT_LT((w.array() / kMean - 1).abs().maxCoeff(), 1e-12) << w;
    EXPECT_EQ(share_out(at, 1).station[0], 15);
    EXPECT_EQ(share_out(at, -1).station[0], 0);
  }
}

}  // namespace
}  // namespace elastogear::evaluation::face_stations_test
