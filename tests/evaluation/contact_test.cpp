#include "elastogear/evaluation/contact.h"

#include <gtest/gtest.h>

#include "../message_of.h"
#include "elastogear/gear/modification.h"
#include "evaluation/load/pattern.h"
#include "rigid_drives.h"

namespace elastogear::evaluation::contact_test {
namespace {

FlankContact contact(int tooth_1, int tooth_2, double force, double pressure = 0) {
  FlankContact c{
      .flank = {gear::Flank{tooth_1, 1}, gear::Flank{tooth_2, -1}}, .x_B = {}, .x_W = {}, .n = {}, .f = {}};
  c.x_B = {Eigen::Vector3d(0.025, 0, 0.002), Eigen::Vector3d(0.065, 0, 0.002)};
  c.normal_force = force;
  c.pressure = pressure;
  return c;
}

TEST(ToothPairs, share_the_load_and_give_the_contact_ratio) {
  const ContactHistory contacts = {{contact(0, 5, 30), contact(0, 5, 30), contact(1, 6, 40)},
                                   {contact(1, 6, 80), contact(0, 5, 0.01)},
                                   {},
                                   {contact(1, 6, 50), contact(2, 7, 50)}};
  const ToothPairs pairs = tooth_pairs(contacts);
  ASSERT_EQ(pairs.tooth.size(), 3);
  EXPECT_EQ(pairs.tooth[1], (std::array<int, 2>{1, 6}));
  EXPECT_DOUBLE_EQ(pairs.share(0, 0), 0.6);
  EXPECT_DOUBLE_EQ(pairs.share(3, 2), 0.5);
  EXPECT_EQ(pairs.share.row(2).sum(), 0);
  EXPECT_EQ(pairs.count, Eigen::Vector4i(2, 1, 0, 2));
  EXPECT_DOUBLE_EQ(contact_ratio(pairs), 1.25);
  EXPECT_EQ(loaded_side(contacts, 0), 1);
  EXPECT_EQ(loaded_side(contacts, 1), -1);
  EXPECT_EQ(loaded_side({}, 1), 0);
}

// One face of the pinion's tooth 3, which is the master of node 0 of the wheel's tooth 9.
struct TwoFaces {
  model::Surface surface[2];
  explicit TwoFaces(double z) {
    for (int g : {0, 1}) {
      surface[g].X = Eigen::Matrix3Xd::Zero(3, 4);
      surface[g].X << 0.024, 0.026, 0.026, 0.024, 0, 0, 0, 0, -z, -z, z, z;
      surface[g].face = Eigen::Vector4i(0, 1, 2, 3);
      surface[g].group = {0};
      surface[g].group_name = {g == 0 ? "tooth_03_left" : "tooth_09_right"};
    }
  }
};

TEST(FlankContacts, have_the_teeth_of_their_groups_and_the_place_on_the_masters_face) {
  const test::RollingPair pair = test::spur_pair();
  const TwoFaces faces(0.01);
  const std::array<Flanks, 2> of{flanks(pair.gear[0].toothing, faces.surface[0]),
                                 flanks(pair.gear[1].toothing, faces.surface[1])};
  EXPECT_EQ(node_layers(of[0]), Eigen::Vector2d(-0.01, 0.01));
  model::ContactRecord record;
  record.slave_side = 1;
  record.xi = 0.5, record.eta = -0.5;
  record.f = Eigen::Vector3d(1, 2, 3);
  record.pressure = 7;
  const auto all = flank_contacts({record}, pair.both(), of, 2);
  ASSERT_EQ(all.size(), 1);
  EXPECT_EQ(all[0].flank[0].tooth, 2);
  EXPECT_EQ(all[0].flank[0].side, 1);
  EXPECT_EQ(all[0].flank[1].tooth, 8);
  EXPECT_EQ(all[0].flank[1].side, -1);
  EXPECT_LT((all[0].x_B[0] - Eigen::Vector3d(0.0255, 0, -0.005)).norm(), 1e-15);
  EXPECT_LT((pair.gear[1].position[2] + pair.gear[1].rotation[2] * all[0].x_B[1] - all[0].x_W).norm(), 1e-15);
  EXPECT_EQ(all[0].f, record.f);
  record.slave_side = 0;
  EXPECT_EQ(flank_contacts({record}, pair.both(), of, 2)[0].f, Eigen::Vector3d(-record.f));
  record.face = 3;
  EXPECT_NE(test::message_of([&] { flank_contacts({record}, pair.both(), of, 2); }).find("no face 3"),
            std::string::npos);
}

// A triangle has the coordinates of the quadrilateral whose last two corners meet: these are half way along
// its first side, and its third corner.
TEST(FlankContacts, are_at_the_place_on_a_triangle) {
  const test::RollingPair pair = test::spur_pair();
  TwoFaces faces(0.01);
  faces.surface[0].face = Eigen::Vector4i(0, 1, 2, 2);
  const std::array<Flanks, 2> of{flanks(pair.gear[0].toothing, faces.surface[0]),
                                 flanks(pair.gear[1].toothing, faces.surface[1])};
  model::ContactRecord record;
  record.slave_side = 1;
  for (const auto& [xi, eta, expected] : {std::tuple(0.0, -1.0, Eigen::Vector3d(0.025, 0, -0.01)),
                                          std::tuple(0.5, 1.0, Eigen::Vector3d(0.026, 0, 0.01))}) {
    record.xi = xi, record.eta = eta;
    const auto all = flank_contacts({record}, pair.both(), of, 2);
    ASSERT_EQ(all.size(), 1);
    EXPECT_LT((all[0].x_B[0] - expected).norm(), 1e-15);
  }
}

TEST(ContactPattern, holds_the_largest_pressure_of_all_teeth_at_each_place) {
  const test::RollingPair pair = test::spur_pair();
  const Gear& gear = pair.gear[0];
  const ContactHistory contacts = {
      {contact(0, 5, 10, 3e6)}, {contact(1, 6, 10, 5e6)}, {contact(2, 7, 1, 4e6)}};
  const auto pattern = contact_pattern(contacts, gear, 0, 1, 0.5e-3, at_layers(gear.layers));
  ASSERT_TRUE(pattern);
  EXPECT_FALSE(contact_pattern(contacts, gear, 0, -1, 0.5e-3, at_layers(gear.layers)));
  Eigen::Index p = 0, z = 0;
  EXPECT_EQ(pattern->pressure.maxCoeff(&p, &z), 5e6);
  EXPECT_EQ((pattern->pressure.array() > 0).count(), (pattern->pressure.array() == 5e6).count());
  const double roll = gear::length_of_roll(gear.toothing, 0.025);
  for (Eigen::Index i = 0; i < pattern->profile.size(); ++i)
    for (Eigen::Index j = 0; j < pattern->z.size(); ++j)
      if (pattern->pressure(i, j) > 0) {
        EXPECT_LT(std::abs(pattern->profile[i] - roll), 0.5e-3 + 0.3e-3);
        EXPECT_LT(std::abs(pattern->z[j] - 0.002), 2.5e-3 + 0.3e-3);
      }
  // Within what both faces have in common.
  const auto narrow =
      contact_pattern(contacts, gear, 0, 1, 0.5e-3, at_layers(Eigen::Vector3d(-0.003, 0, 0.003)));
  ASSERT_TRUE(narrow);
  for (Eigen::Index j = 0; j < narrow->z.size(); ++j)
    if (std::abs(narrow->z[j]) > 0.003 + 0.3e-3) {
      EXPECT_EQ(narrow->pressure.col(j).maxCoeff(), 0);
    }
  EXPECT_EQ(largest_pressure(contacts)->step, 1);
  EXPECT_FALSE(largest_pressure({}));
}

}  // namespace
}  // namespace elastogear::evaluation::contact_test
