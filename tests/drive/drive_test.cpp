// Gears of a drive in place: flanks of one side touch, those of the other one have the backlash between them.

#include "elastogear/drive/drive.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"
#include "elastogear/drive/exact_flanks.h"
#include "elastogear/gear/flank.h"
#include "elastogear/gear/wheel.h"

namespace elastogear::drive::drive_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

gear::CylindricalDrive pair_of(double beta, bool internal) {
  gear::CylindricalDrive d;
  d.m_n = 3e-3;
  d.beta = beta;
  d.rack = gear::basic_rack("A");
  d.j_n = 90e-6;
  d.gears.resize(2);
  d.gears[0] = {.name = "pinion", .z = 17, .x = 0.3, .cutter = {}, .blank = {.face_width = 12e-3}};
  d.gears[1] = {.name = "wheel",
                .z = internal ? 53 : 23,
                .internal = internal,
                .cutter = {},
                .blank = {.face_width = 12e-3}};
  d.pairs = {{.first = 0, .second = 1, .direction = internal ? std::numbers::pi : 0.0}};
  return d;
}

Drive start(const gear::CylindricalDrive& design, const Start& at) {
  return cylindrical_drive(design, gear::derive(design), at);
}

Matrix3d turned(const Member& member) {
  return rotation_matrix(member.rotation) * rotation_matrix({0, 0, member.angle});
}

// m, the least distance of points on flanks of a side of the first gear from those of the second.
double least_gap(const Drive& drive, int side) {
  const Member &first = drive.members[0], &second = drive.members[1];
  const auto flanks = exact_flanks(first.toothing, {}, Layers::transverse);
  const auto [lower, upper, tip_at_upper, edge] = flanks->extent();
  const gear::Toothing& t = second.toothing;
  double least = INFINITY;
  for (int tooth = 0; tooth < first.toothing.z; ++tooth)
    for (int i = 0; i <= 400; ++i)
      for (double z : {-4e-3, 0.0, 4e-3}) {
        const Vector3d x = flanks->point({tooth, side}, std::lerp(lower, upper, i / 400.), z).x;
        const Vector3d y =
            turned(second).transpose() * (first.position + turned(first) * x - second.position);
        const double r = y.head<2>().norm();
        if (r < std::min(t.r_form, t.r_a) || r > std::max(t.r_form, t.r_a)) continue;
        const gear::Flank mate = gear::nearest_flank(t, y);
        least = std::min(least, gear::flank_distance(t, mate.tooth, mate.side, y));
      }
  return least;
}

constexpr double kSampled = 2e-7;  // m, by which sampled points miss the place of contact

TEST(Drive, flanks_of_the_side_touch_and_the_others_have_the_backlash) {
  for (double beta : {0.0, 0.3})
    for (bool internal : {false, true})
      for (bool coasts : {false, true})
        for (double roll : {0.0, 0.37}) {
          const Drive drive = start(pair_of(beta, internal), {roll, coasts});
          const int touching = coasts ? -1 : 1;
          EXPECT_NEAR(least_gap(drive, touching), 0, kSampled) << beta << internal << coasts << roll;
          EXPECT_NEAR(least_gap(drive, -touching), 90e-6, kSampled) << beta << internal << coasts << roll;
        }
}

TEST(Drive, an_axial_offset_is_that_of_a_screw) {
  Drive drive = start(pair_of(0.3, false), {});
  misalign(drive, {{.axial = 1e-3}, {}});
  EXPECT_NEAR(drive.members[0].position[2], 1e-3, 1e-15);
  EXPECT_NEAR(least_gap(drive, 1), 0, kSampled);
}

TEST(Drive, axes_move_and_lean_as_told) {
  Drive drive = start(pair_of(0, false), {});
  const double a = (drive.members[1].position - drive.members[0].position).norm();
  misalign(drive, {{}, {.radial = 20e-6, .tangential = 30e-6, .inclination = 1e-3, .skew = 2e-3}});
  const Vector3d axis = rotation_matrix(drive.members[1].rotation).col(2);
  EXPECT_LT((drive.members[1].position - Vector3d(a + 20e-6, 30e-6, 0)).norm(), 1e-12);
  EXPECT_NEAR(axis[0], 1e-3, 3e-6);  // away from the mate
  EXPECT_NEAR(axis[1], 2e-3, 3e-6);
  EXPECT_NEAR(least_gap(start(pair_of(0, false), {}), 1), 0, kSampled);
  EXPECT_THROW(misalign(drive, {{}}), Error);
}

TEST(Drive, gears_turn_by_their_teeth) {
  const Drive external = start(pair_of(0, false), {}), internal = start(pair_of(0, true), {});
  EXPECT_DOUBLE_EQ(external.members[1].ratio, -17. / 23);
  EXPECT_DOUBLE_EQ(internal.members[1].ratio, 17. / 53);
  EXPECT_EQ(pair_name(external, external.pairs[0]), "pinion:wheel");
}

TEST(Drive, a_worm_lies_across_its_wheel) {
  const gear::Design design = gear::proportioned(2e-3, 20 * std::numbers::pi / 180, 2, 41, 50e-3);
  for (gear::Hand hand : {gear::Hand::right, gear::Hand::left}) {
    gear::Design of = design;
    of.hand = hand;
    const Drive drive = worm_drive(of, gear::derive(of), {});
    const Vector3d worm = rotation_matrix(drive.members[0].rotation).col(2);
    EXPECT_LT((worm - Vector3d::UnitX()).norm(), 1e-12);
    EXPECT_LT((drive.members[0].position - Vector3d(0, 50e-3, 0)).norm(), 1e-15);
    EXPECT_NEAR(drive.members[1].ratio, (hand == gear::Hand::left ? -1 : 1) * 2 / 41., 1e-12);
  }
}

TEST(Drive, designs_compare_by_all_their_numbers) {
  const gear::CylindricalDrive design = pair_of(0.3, false);
  gear::CylindricalDrive other = design;
  EXPECT_EQ(other, design);
  other.gears[1].blank.bore = 1e-3;
  EXPECT_NE(other, design);
  gear::Design worm = gear::proportioned(2e-3, 0.35, 2, 41, 50e-3);
  EXPECT_EQ(worm, gear::proportioned(2e-3, 0.35, 2, 41, 50e-3));
  worm.hand = gear::Hand::left;
  EXPECT_NE(worm, gear::proportioned(2e-3, 0.35, 2, 41, 50e-3));
}

// Twice the rows and columns of the section, and the square root of two times the layers and the ring's rows.
TEST(Drive, meshes_are_as_fine_as_asked) {
  const Drive drive = start(pair_of(0, false), {});
  mesh::ReadReport report;
  const int coarse = drive.members[0].mesh({}, report).cells.size(),
            fine = drive.members[0].mesh({.refinement = 2}, report).cells.size();
  EXPECT_GT(fine, 4 * coarse);
  EXPECT_LT(fine, 6.1 * coarse);
}

}  // namespace
}  // namespace elastogear::drive::drive_test
