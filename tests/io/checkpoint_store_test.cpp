#include "elastogear/io/checkpoint_store.h"

#include <gtest/gtest.h>

#include <limits>

#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "elastogear/io/record_file.h"
#include "sample_body.h"

namespace elastogear::checkpoint_store_test {
using namespace io;

namespace {

struct Pieces : testing::Test {
  mesh::Folder folder{"checkpoints"};
  std::string path = folder / "body.h5.partial";
  Eigen::MatrixXd A = Eigen::MatrixXd::Random(3, 2);
  Eigen::VectorXd row = Eigen::VectorXd::Random(1000);

  Pieces() { A(1, 1) = -std::numeric_limits<double>::infinity(); }

  void write(CheckpointStore& store, const std::string& name) const {
    CheckpointWriter writer(store, name);
    writer.write("A", A);
    for (int i = 0; i < 200; ++i) writer.append("rows", row * i);
    writer.append("single", row, Precision::float32);
    writer.append("none", Eigen::VectorXd{});
    writer.commit();
  }
};

TEST_F(Pieces, come_back_to_the_bit_in_a_new_store) {
  {
    CheckpointStore store(path, "same");
    write(store, "b");
    write(store, "a");
  }
  const CheckpointStore store(path, "same");
  EXPECT_EQ(store.names(), (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(store.discarded(), 0);
  const CheckpointReader checkpoint(store, "b");
  EXPECT_EQ(checkpoint.read("A"), A);
  ASSERT_EQ(checkpoint.n_rows("rows"), 200);
  for (int i : {0, 63, 64, 199}) EXPECT_EQ(checkpoint.read_row("rows", i), row * i);
  EXPECT_EQ(checkpoint.read_row("single", 0), row.cast<float>().cast<double>());
  EXPECT_EQ(checkpoint.n_rows("none"), 1);
  EXPECT_FALSE(checkpoint.has("B"));
  EXPECT_THROW(checkpoint.read("B"), Error);
}

TEST_F(Pieces, appear_only_when_complete) {
  CheckpointStore store(path, "same");
  {
    CheckpointWriter writer(store, "a");
    writer.write("A", A);
  }
  EXPECT_TRUE(store.names().empty());
  EXPECT_TRUE(CheckpointStore(path, "same").names().empty());
}

TEST_F(Pieces, of_another_fingerprint_and_damaged_ones_are_removed) {
  CheckpointStore store(path, "one");
  write(store, "a");
  write(store, "b");
  const std::string content = read_file(store.path("b"));
  write_file(store.path("b"), content.substr(0, content.size() / 2));
  write_file(store.path("c") + ".tmp1", "left by a killed run");
  const CheckpointStore same(path, "one");
  EXPECT_EQ(same.names(), std::vector<std::string>{"a"});
  EXPECT_EQ(same.discarded(), 1);
  const CheckpointStore other(path, "two");
  EXPECT_TRUE(other.names().empty());
  EXPECT_EQ(other.discarded(), 1);
  EXPECT_TRUE(std::filesystem::is_empty(path));
}

TEST_F(Pieces, leave_what_a_run_of_the_same_name_left) {
  std::filesystem::create_directories(path);
  write_record(path + "/other.h5", {{}, {1}});
  CheckpointStore store(path, "one");
  EXPECT_EQ(store.discarded(), 0);
  write(store, "a");
  store.clear();
  EXPECT_EQ(read_record(path + "/other.h5").numbers, std::vector<double>{1});
}

TEST_F(Pieces, leave_nothing_when_cleared_but_what_is_not_theirs) {
  CheckpointStore store(path, "one");
  write(store, "a");
  write_file(path + "/note.txt", "mine");
  store.clear();
  EXPECT_EQ(read_file(path + "/note.txt"), "mine");
  std::filesystem::remove(path + "/note.txt");
  write(store, "a");
  store.clear();
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST_F(Pieces, in_a_folder_that_cannot_be_made_are_an_error) {
  CheckpointStore store("/proc/nowhere/checkpoints", "one");
  EXPECT_THROW(CheckpointWriter(store, "a"), Error);
}

}  // namespace
}  // namespace elastogear::checkpoint_store_test
