#include <gtest/gtest.h>

#include <sys/stat.h>

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

TEST_F(File, takes_the_place_of_no_pipe) {
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  EXPECT_THROW(write_file(path, "text"), Error);
  EXPECT_TRUE(fs::is_fifo(path));
  EXPECT_EQ(files(), 1);
}

TEST_F(File, is_written_where_a_link_leads) {
  fs::create_directory(folder / "far");
  const std::string link = (folder / "link.txt").string();
  fs::create_symlink("far/b.txt", link);
  for (const char* content : {"new", "newer"}) {
    write_file(link, content);
    EXPECT_TRUE(fs::is_symlink(link));
    EXPECT_EQ(read_file((folder / "far" / "b.txt").string()), content);
  }
  EXPECT_EQ(files(), 2);
  fs::create_symlink("loop.txt", folder / "loop.txt");
  EXPECT_THROW(write_file((folder / "loop.txt").string(), ""), Error);
}

TEST_F(File, and_a_folder_take_the_place_of_what_is_there) {
  const std::string a = folder / "a", b = folder / "b", c = folder / "c";
  for (const std::string& one : {a, b}) {
    fs::create_directory(one);
    write_file(one + "/name", one);
  }
  put_in_place(a, b);
  EXPECT_EQ(read_file(b + "/name"), a);
  EXPECT_FALSE(fs::exists(a));
  write_file(a, "file");
  put_in_place(b, a);
  EXPECT_EQ(read_file(a + "/name"), a);
  put_in_place(a, c);
  EXPECT_EQ(files(), 1);
  EXPECT_THROW(put_in_place(c, folder / "none/c"), WriteFailure);
  EXPECT_TRUE(fs::exists(c + "/name"));
}

TEST_F(File, follows_no_link_under_its_temporary_name) {
  write_file(path, "of another");
  const PendingFile pending((folder / "b.txt").string());
  fs::create_symlink(path, pending.temporary());
  EXPECT_THROW(write_file((folder / "b.txt").string(), "text"), Error);
  EXPECT_EQ(read_file(path), "of another");
}

TEST_F(File, is_read_behind_the_mark_of_utf_8) {
  write_file(path, "\xEF\xBB\xBFtext");
  EXPECT_EQ(read_file(path), "text");
  EXPECT_EQ(read_text(path), "text");
  std::string word;
  open_input(path) >> word;
  EXPECT_EQ(word, "text");
  write_file(path, "a");  // shorter than the mark
  open_input(path) >> word;
  EXPECT_EQ(word, "a");
}

TEST_F(File, of_text_is_refused_in_utf_16) {
  write_file(path, std::string("\xFF\xFEt\0", 4));
  EXPECT_THROW(read_text(path), Error);
  EXPECT_THROW(open_input(path), Error);
  EXPECT_EQ(read_file(path).size(), 4u);
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
