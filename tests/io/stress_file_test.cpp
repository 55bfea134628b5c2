#include "elastogear/io/stress_file.h"

#include <gtest/gtest.h>
#include <hdf5.h>

#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "elastogear/io/csv.h"
#include "sample_body.h"

namespace elastogear::io::stress_file_test {
namespace {

struct StressFileTest : testing::Test {
  mesh::Folder folder{"stress_file"};
  StressFile history;

  StressFileTest() {
    history.time = Eigen::Vector2d(0, 1e-6);
    history.sets = {{"worm",
                     "root",
                     {4, 7},
                     Eigen::MatrixXd::Random(12, 2),
                     Eigen::MatrixXd::Random(2, 2),
                     Eigen::MatrixXd::Random(2, 2),
                     Eigen::Matrix3Xd::Random(3, 2)}};
  }
};

TEST_F(StressFileTest, gives_back_what_was_written) {
  write_stress(folder / "a.h5", history);
  const StressFile read = read_stress(folder / "a.h5");
  ASSERT_EQ(read.sets.size(), 1u);
  EXPECT_EQ(read.time, history.time);
  EXPECT_EQ(read.sets[0].node, history.sets[0].node);
  EXPECT_EQ(read.sets[0].stress, history.sets[0].stress);
  EXPECT_EQ(read.sets[0].X, history.sets[0].X);
}

TEST_F(StressFileTest, says_the_torque_of_its_run) {
  history.input = {model::Analysis::sweep, false, model::DriveInput{0, -300, 0}};
  write_stress(folder / "a.h5", history);
  const auto input = read_stress(folder / "a.h5").input;
  ASSERT_TRUE(input && input->drive);
  EXPECT_EQ(input->drive->torque, -300);
  EXPECT_EQ(input->analysis, model::Analysis::sweep);
}

TEST_F(StressFileTest, keeps_the_estimated_errors) {
  history.sets[0].mesh_error = Eigen::MatrixXd::Random(2, 2);
  history.sets[0].contact_error = Eigen::MatrixXd::Random(2, 2);
  history.sets[0].time_error = Eigen::MatrixXd::Random(2, 2);
  write_stress(folder / "a.h5", history);
  EXPECT_EQ(read_stress(folder / "a.h5").sets[0].mesh_error, history.sets[0].mesh_error);
  EXPECT_EQ(read_stress(folder / "a.h5").sets[0].contact_error, history.sets[0].contact_error);
  EXPECT_EQ(read_stress(folder / "a.h5").sets[0].time_error, history.sets[0].time_error);
  history.sets[0].mesh_error.resize(2, 1);
  EXPECT_THROW(write_stress(folder / "b.h5", history), Error);
}

TEST_F(StressFileTest, may_lack_positions_but_not_those_of_some_nodes) {
  history.sets[0].X.resize(3, 0);
  write_stress(folder / "a.h5", history);
  EXPECT_EQ(read_stress(folder / "a.h5").sets[0].X.size(), 0);
  history.sets[0].X.setZero(3, 1);
  EXPECT_THROW(write_stress(folder / "b.h5", history), Error);
}

TEST_F(StressFileTest, holds_numbers_that_nodes_can_have) {
  write_stress(folder / "a.h5", history);
  history.sets[0].node[1] = -7;
  EXPECT_THROW(write_stress(folder / "b.h5", history), Error);
  const hid_t file = H5Fopen((folder / "a.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT),
              dataset = H5Dopen2(file, "/worm/root/nodes", H5P_DEFAULT);
  H5Dwrite(dataset, H5T_NATIVE_INT, H5S_ALL, H5S_ALL, H5P_DEFAULT, history.sets[0].node.data());
  H5Dclose(dataset);
  H5Fclose(file);
  EXPECT_THROW(read_stress(folder / "a.h5"), Error);
}

TEST_F(StressFileTest, a_table_may_name_its_rows) {
  write_csv(folder / "a.csv",
            {{"node", "1", {}, {"worm root", "wheel root"}}, {"force", "N", Eigen::Vector2d(1, 2)}});
  EXPECT_EQ(read_file(folder / "a.csv"), "node,force [N]\nworm root,1\nwheel root,2\n");
  EXPECT_THROW(write_csv(folder / "b.csv", {{"node", "1", {}, {"worm, root"}}}), Error);
}

}  // namespace
}  // namespace elastogear::io::stress_file_test
