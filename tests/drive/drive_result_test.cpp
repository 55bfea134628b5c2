// A result file of a drive gives back the pairs of gears that the sweep which wrote it has returned.

#include "elastogear/drive/drive_result.h"

#include <gtest/gtest.h>

#include "../mesh/box_mesh.h"
#include "elastogear/base/error.h"
#include "elastogear/base/petsc.h"
#include "elastogear/drive/reduce.h"
#include "elastogear/drive/sweep_drive.h"

namespace elastogear::drive::drive_result_test {
namespace {

Drive pair_of_gears() {
  gear::CylindricalDrive d;
  d.m_n = 3e-3;
  d.rack = gear::basic_rack("A");
  d.gears.resize(2);
  d.gears[0] = {.name = "pinion", .z = 17, .x = 0.3, .cutter = {}, .blank = {.face_width = 12e-3}};
  d.gears[1] = {.name = "wheel", .z = 23, .x = 0.1, .cutter = {}, .blank = {.face_width = 12e-3}};
  d.pairs = {{.first = 0, .second = 1}};
  return cylindrical_drive(d, gear::derive(d), {});
}

// A sweep over two positions, with what it has returned.
struct Swept : testing::Test {
  mesh::Folder folder{"drive_result"};
  std::string path = folder / "result.h5";
  Drive drive = pair_of_gears();
  std::vector<evaluation::PairOfRun> returned;

  Swept() {
    std::vector<std::string> files;
    for (const Member& gear : drive.members) {
      files.push_back(folder / (gear.name + ".h5"));
      mesh::ReadReport report;
      reduction::reduce(PETSC_COMM_SELF, gear.mesh({.size = gear::Size::tiny, .order = 1}, report),
                        reduction_options(gear, {.E = 210e9, .nu = 0.3, .rho = 7850}), files.back());
    }
    returned = sweep_drive(drive, {.torque = 100, .speed = 50}, files, {0, 0.5}, path);
  }
};

TEST_F(Swept, is_read_back_to_the_bit) {
  BodyFiles bodies;
  const DriveResult result = open_result(path, {});
  EXPECT_EQ(result.analysis, Analysis::sweep);
  const DriveRun run = read_result({drive}, {}, result, bodies, {});
  ASSERT_EQ(run.pairs.size(), 1u);
  EXPECT_TRUE(run.notes.empty());
  EXPECT_EQ(run.pairs[0].name, "pinion:wheel");
  const evaluation::PairOfRun &read = run.pairs[0].run, &pair = returned[0];
  EXPECT_EQ(read.roll, pair.roll);
  EXPECT_EQ(read.force, pair.force);
  EXPECT_EQ(read.torque, pair.torque);
  EXPECT_EQ(read.strips, pair.strips);
  EXPECT_EQ(read.speed, 50);
  EXPECT_EQ(read.sense, 1);
  EXPECT_EQ(read.compliance, pair.compliance);
  EXPECT_EQ(evaluation::transmission_error(read), evaluation::transmission_error(pair));
  for (int g : {0, 1}) {
    ASSERT_TRUE(read.root[g] && pair.root[g]);
    EXPECT_EQ(read.root[g]->stress, pair.root[g]->stress);
    EXPECT_EQ(read.root[g]->error, pair.root[g]->error);
  }
  EXPECT_EQ(read.unloaded, Eigen::VectorXd::Zero(2));  // of exact flanks
  const TransmissionErrors errors = transmission_errors({drive}, result, bodies);
  EXPECT_EQ(errors.at("pinion:wheel"), evaluation::transmission_error(pair));
}

TEST_F(Swept, has_no_unloaded_error_of_flanks_that_are_not_exact) {
  BodyFiles bodies;
  DriveResult result = open_result(path, {});
  result.header.input->inexact = {"wheel"};
  const DriveRun run = read_result({drive}, {.roots = false}, result, bodies, {});
  EXPECT_EQ(run.pairs[0].run.unloaded.size(), 0);
  EXPECT_FALSE(run.pairs[0].run.root[0]);
  EXPECT_EQ(run.notes.size(), 1u);
}

TEST_F(Swept, is_not_that_of_another_drive) {
  BodyFiles bodies;
  const DriveResult result = open_result(path, {});
  EXPECT_THROW(open_result(path, {.from = 0.25}), Error);  // a span is of motions
  Drive renamed = drive;
  renamed.members[1].name = "gear";
  EXPECT_THROW(read_result({renamed}, {}, result, bodies, {}), Error);
  EXPECT_THROW(read_result({drive, false, {}, {{"pinion", folder / "wheel.h5"}}}, {}, result, bodies, {}),
               Error);
}

}  // namespace
}  // namespace elastogear::drive::drive_result_test
