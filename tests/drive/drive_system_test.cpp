// The system of a drive under load: what turns, what holds, and what carries the torque.

#include "elastogear/drive/drive_system.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"

namespace elastogear::drive::drive_system_test {
namespace {

using Eigen::Vector3d;

Drive pair_of_gears() {
  gear::CylindricalDrive d;
  d.m_n = 3e-3;
  d.rack = gear::basic_rack("A");
  d.gears.resize(2);
  d.gears[0] = {.name = "pinion", .z = 17, .x = 0.3, .cutter = {}, .blank = {.face_width = 12e-3}};
  d.gears[1] = {.name = "wheel", .z = 43, .cutter = {}, .blank = {.face_width = 12e-3}};
  d.pairs = {{.first = 0, .second = 1}};
  return cylindrical_drive(d, gear::derive(d), {});
}

const std::vector<Bearing> kBearings = {{"near", 10e-3, 2e8, 1e8, 0}, {"far", -10e-3, 1e8, 0, 0}};

TEST(DriveSystem, a_sweep_loads_the_first_gear_and_leads_the_last) {
  const Drive drive = pair_of_gears();
  const DriveSystem system = drive_system(drive, {.torque = 30, .speed = 5});
  ASSERT_EQ(system.bodies.size(), 2u);
  const dynamics::BodySetup &pinion = system.bodies[0], &wheel = system.bodies[1];
  EXPECT_EQ(pinion.joint.type, body::JointType::revolute);
  EXPECT_EQ(at(pinion.rotation.load, 0), 30);
  EXPECT_EQ(pinion.rotation.s_0, drive.members[0].angle);
  EXPECT_EQ(pinion.rotation.s_dot_0, 0);  // nothing moves
  ASSERT_TRUE(wheel.rotation.drive);
  EXPECT_EQ(at(*wheel.rotation.drive, 7.0).s, drive.members[1].angle);
  EXPECT_EQ(wheel.joint.r_WB0, drive.members[1].position);
  ASSERT_EQ(system.pairs.size(), 1u);
  EXPECT_EQ(system.pairs[0].name, "pinion:wheel");
  EXPECT_EQ(system.pairs[0].settings.points, contact::SlavePoints::stations);
  EXPECT_TRUE(system.markers.bushings.empty() && system.markers.loads.empty());
}

TEST(DriveSystem, at_rest_the_last_gear_is_fixed_as_it_stands) {
  const Drive drive = pair_of_gears();
  const dynamics::BodySetup wheel =
      drive_system(drive, {.analysis = Analysis::equilibrium, .torque = 30}).bodies[1];
  EXPECT_EQ(wheel.joint.type, body::JointType::fixed);
  EXPECT_LT((wheel.joint.R_WB0 - rotation_matrix({0, 0, drive.members[1].angle})).norm(), 1e-14);
  EXPECT_FALSE(wheel.rotation.drive);
}

TEST(DriveSystem, a_motion_has_the_torques_and_speeds_of_the_teeth) {
  const DriveSystem system =
      drive_system(pair_of_gears(), {.analysis = Analysis::motion, .torque = 30, .speed = 5});
  EXPECT_DOUBLE_EQ(at(system.bodies[1].rotation.load, 0), 30 * 43. / 17);  // against the turning wheel
  EXPECT_EQ(system.bodies[0].rotation.s_dot_0, 5);
  EXPECT_DOUBLE_EQ(system.bodies[1].rotation.s_dot_0, -5 * 17. / 43);
}

TEST(DriveSystem, says_what_its_run_was_asked_for) {
  Drive drive = pair_of_gears();
  const Operation operation{.analysis = Analysis::motion, .torque = -30, .speed = -5};
  const model::RunInput exact = run_input(drive, operation, 0.5);
  ASSERT_TRUE(exact.drive);
  EXPECT_EQ(exact.analysis, Analysis::motion);
  EXPECT_EQ(exact.drive->torque, -30);
  EXPECT_EQ(exact.drive->speed, -5);
  EXPECT_EQ(exact.drive->roll, 0.5);
  EXPECT_TRUE(exact.inexact.empty());
  drive.members[0].deviations.emplace();
  misalign(drive, {{}, {.skew = 1e-3}});
  EXPECT_EQ(run_input(drive, operation, 0.5).inexact, (std::vector<std::string>{"pinion", "wheel"}));
  EXPECT_FALSE(drive.members[0].misaligned);
}

TEST(DriveSystem, gears_in_bearings_are_free_and_a_stiff_spring_holds_the_last) {
  const Drive drive = pair_of_gears();
  const DriveSystem system = drive_system(drive, {.torque = 30, .bearings = {kBearings, kBearings}});
  for (const dynamics::BodySetup& body : system.bodies) EXPECT_EQ(body.joint.type, body::JointType::free);
  ASSERT_EQ(system.markers.loads.size(), 1u);
  EXPECT_EQ(system.markers.loads[0].marker.body, "pinion");
  EXPECT_EQ(system.markers.loads[0].torque, Vector3d(0, 0, 30));
  EXPECT_TRUE(system.markers.loads[0].follows);
  ASSERT_EQ(system.markers.bushings.size(), 4u);
  const dynamics::BushingSetup &first = system.markers.bushings[0], &held = system.markers.bushings[2];
  EXPECT_TRUE(first.marker[0].body.empty());
  EXPECT_EQ(first.marker[1].marker, "near");
  EXPECT_EQ(first.law.k, Vector3d(2e8, 2e8, 1e8));
  EXPECT_EQ(first.law.k_r[2], 0);
  EXPECT_NEAR(30 * 43. / 17 / held.law.k_r[2], 1e-8, 1e-20);
  EXPECT_EQ(system.markers.bushings[3].law.k_r[2], 0);
}

TEST(DriveSystem, bearings_must_hold_the_gear) {
  const Drive drive = pair_of_gears();
  const auto with = [&](const std::vector<Bearing>& bearings) {
    return drive_system(drive, {.torque = 30, .bearings = {bearings}});
  };
  EXPECT_NO_THROW(with(kBearings));
  EXPECT_THROW(with({{"a", -1e-2, 1e8, 0, 0}, {"b", 1e-2, 1e8, 0, 0}}), Error);  // slides
  EXPECT_THROW(with({{"a", 0, 1e8, 1e8, 0}, {"b", 0, 1e8, 0, 0}}), Error);       // tilts
  EXPECT_THROW(with({{"a", 0, 0, 1e8, 1e3}}), Error);
  EXPECT_THROW(with({{"a", 0, 1e8, 1e8, -1e3}}), Error);
}

TEST(DriveSystem, a_sweep_turns_gears_by_their_teeth) {
  const Drive drive = pair_of_gears();
  Operation operation{.torque = 30, .bearings = {{}, kBearings}};
  DriveSystem system = drive_system(drive, operation);
  system.pairs[0].settings.friction.mu = 0.1;
  const double pitch = 2 * std::numbers::pi / 17;
  dynamics::SlowMotion motion = slow_motion(drive, operation, system);
  ASSERT_EQ(motion.rate.size(), 2u);
  EXPECT_DOUBLE_EQ(motion.rate[0], pitch);
  EXPECT_DOUBLE_EQ(motion.rate[1], -2 * std::numbers::pi / 43);
  ASSERT_EQ(motion.bushing_rate.size(), 2u);
  EXPECT_DOUBLE_EQ(motion.bushing_rate[1], motion.rate[1]);
  EXPECT_DOUBLE_EQ(motion.pairs[0].settings.friction.v_0, 1e-3 * pitch * drive.members[0].toothing.r);
  system.pairs[0].settings.friction.v_0 = 2e-3;
  operation.speed = -4;
  motion = slow_motion(drive, operation, system);
  EXPECT_DOUBLE_EQ(motion.pairs[0].settings.friction.v_0, 2e-3 * pitch / 4);
}

TEST(DriveSystem, markers_stand_at_bearings_off_the_frame) {
  model::ElasticBody body;
  add_bearing_markers({{"middle", 0, 1e8, 1e8, 1e3}, {"far", -10e-3, 1e8, 0, 0}}, body);
  ASSERT_EQ(body.markers.size(), 1u);
  EXPECT_EQ(body.markers[0].name, "far");
  EXPECT_EQ(body.markers[0].X, Vector3d(0, 0, -10e-3));
}

// A face of the left flank of tooth 1 of that gear, counter-clockwise seen from outside.
model::Surface face_of(const Member& member) {
  const auto flanks = exact_flanks(member.toothing, {}, Layers::transverse);
  const auto extent = flanks->extent();
  model::Surface surface;
  surface.node = {3, 5, 8, 9};
  surface.X.resize(3, 4);
  surface.face.resize(4, 1);
  surface.face << 0, 1, 2, 3;
  const double v = std::lerp(extent.lower, extent.upper, 0.5), d = 0.1 * (extent.upper - extent.lower);
  const double at[4][2] = {{v - d, -1e-3}, {v - d, 1e-3}, {v + d, 1e-3}, {v + d, -1e-3}};
  for (int i = 0; i < 4; ++i) surface.X.col(i) = flanks->point({0, 1}, at[i][0], at[i][1]).x;
  surface.group = {0};
  surface.group_name = {"tooth_01_left"};
  return surface;
}

TEST(DriveSystem, flanks_stand_behind_the_faces_of_their_own_gear_alone) {
  const Drive drive = pair_of_gears();
  model::Surface surface = face_of(drive.members[0]);
  const FlankSurface found = flank_surface(teeth_of(drive.members[0]), surface, true);
  EXPECT_EQ(found.n_faces, 1);
  EXPECT_LT(found.farthest.distance, 1e-12);
  EXPECT_LT(found.error, 1e-9);
  ASSERT_EQ(found.surface.height.size(), 1u);
  EXPECT_GT(found.surface.height[0].value.cwiseAbs().maxCoeff(), 1e-7);  // the involute bulges
  EXPECT_THROW(flank_surface(teeth_of(drive.members[1]), surface, true), Error);
  surface.X.col(2) += Vector3d(2e-6, 0, 0);
  const OffNode off = farthest_node(teeth_of(drive.members[0]), surface);
  EXPECT_EQ(off.node, 8);
  EXPECT_EQ(off.group, "tooth_01_left");
  EXPECT_THROW(flank_surface(teeth_of(drive.members[0]), surface, true), Error);
  surface.group_name = {"bore"};
  EXPECT_THROW(flank_surface(teeth_of(drive.members[0]), surface, true), Error);
}

}  // namespace
}  // namespace elastogear::drive::drive_system_test
