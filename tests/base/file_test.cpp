#include <gtest/gtest.h>

#include <filesystem>

#include "elastogear/base/error.h"
#include "elastogear/base/file.h"

namespace elastogear::file_test {

namespace fs = std::filesystem;

namespace {

struct File : testing::Test {
  fs::path folder = fs::temp_directory_path() / ("elastogear_file_" + std::to_string(getpid()));
  std::string path = (folder / "a.txt").string();
  void SetUp() override { fs::create_directory(folder); }
  void TearDown() override { fs::remove_all(folder); }
  auto files() const { return std::distance(fs::directory_iterator(folder), fs::directory_iterator()); }
};

TEST_F(File, is_read_as_it_was_written) {
  const std::string content("a\0b\r\n", 5);
  write_file(path, content);
  EXPECT_EQ(read_file(path), content);
  EXPECT_EQ(files(), 1);
}

TEST_F(File, stays_as_it_was_until_the_new_one_is_complete) {
  write_file(path, "old");
  {
    PendingFile pending(path);
    write_file(pending.temporary(), "half");
  }
  EXPECT_EQ(read_file(path), "old");
  EXPECT_EQ(files(), 1);
}

TEST_F(File, names_the_path_that_cannot_be_used) {
  EXPECT_THROW(read_file(path), Error);
  EXPECT_THROW(read_file(folder.string()), Error);
  EXPECT_THROW(write_file(folder.string(), ""), Error);
  EXPECT_THROW(write_file((folder / "none" / "a.txt").string(), ""), Error);
  EXPECT_THROW(write_file("", ""), Error);
}

}  // namespace
}  // namespace elastogear::file_test
