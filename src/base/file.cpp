#include "elastogear/base/file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include "elastogear/base/error.h"

namespace elastogear {
namespace {

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using Stream = std::unique_ptr<std::FILE, Close>;

namespace fs = std::filesystem;

constexpr int kMostLinks = 40;  // as many as Linux follows

constexpr std::string_view kMark = "\xEF\xBB\xBF";              // of text in UTF-8
constexpr std::string_view kWide[] = {"\xFF\xFE", "\xFE\xFF"};  // of text in UTF-16

void refuse_wide(const std::string& path, std::string_view start) {
  for (const std::string_view mark : kWide)
    require(!start.starts_with(mark), path, ", line 1: is text in UTF-16; save it as UTF-8");
}

std::string_view kind_of(const fs::file_status& status) {
  switch (status.type()) {
    case fs::file_type::directory:
      return "a folder";
    case fs::file_type::fifo:
      return "a pipe";
    case fs::file_type::socket:
      return "a socket";
    default:
      return "a device";
  }
}

Stream open(const std::string& path) {
  Stream file(std::fopen(path.c_str(), "rb"));
  require(file != nullptr, path, ": cannot be opened: ", std::strerror(errno));
  return file;
}

// Follows no link that another user has put under the temporary name.
Stream create(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0666);
  Stream file(descriptor < 0 ? nullptr : fdopen(descriptor, "wb"));
  require(file != nullptr, path, ": cannot be opened: ", std::strerror(errno));
  return file;
}

// Waits until a file or folder is on the disk. Returns an errno; file systems that cannot say so are no
// error.
int synchronised(const std::string& path, int mode) {
  const int descriptor = ::open(path.c_str(), mode | O_CLOEXEC);
  if (descriptor < 0) return errno == EACCES ? 0 : errno;
  const int error =
      fsync(descriptor) == 0 || errno == EINVAL || errno == EROFS || errno == ENOSYS ? 0 : errno;
  ::close(descriptor);
  return error;
}

// Moves a file to another file system: copies it beside `place` and renames the copy. Returns an errno, 0 for
// none.
int moved_to_other_disk(const std::string& file, const std::string& place) {
  const std::string copy = place + ".tmp" + std::to_string(getpid());
  std::error_code error;
  fs::copy_file(file, copy, error);
  int failure = error ? error.value() : synchronised(copy, O_RDONLY);
  if (failure == 0 && std::rename(copy.c_str(), place.c_str()) != 0) failure = errno;
  std::remove(failure == 0 ? file.c_str() : copy.c_str());
  return failure;
}

// A folder that has the name is put aside first, because none takes the place of one that holds something.
void put_folder_in_place(const std::string& folder, const std::string& path) {
  const std::string old = path + ".old" + std::to_string(getpid());
  const fs::path parent = fs::path(path).parent_path();
  std::error_code error;
  if (fs::exists(fs::symlink_status(path))) fs::rename(path, old, error);
  if (!error) fs::rename(folder, path, error);
  std::error_code back;
  if (error) fs::rename(old, path, back);
  const int failure =
      error ? error.value() : synchronised(parent.empty() ? "." : parent.string(), O_RDONLY | O_DIRECTORY);
  if (failure != 0) fail_to_write(path, write_error(failure));
  fs::remove_all(old, error);
}

}  // namespace

void fail_to_write(const std::string& path, const std::string& reason) {
  throw WriteFailure(path + ": cannot be written: " + reason);
}

std::string write_error(int error) {
  const bool full = error == ENOSPC || error == EDQUOT || error == EFBIG;
  return full ? "no space left on its disk: free some, then give the same command again"
              : std::string(std::strerror(error));
}

bool is_file(const std::string& path) {
  std::error_code error;
  return std::filesystem::is_regular_file(path, error);
}

void require_file(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  require(fs::exists(status), path, ": there is no such file");
  require(fs::is_regular_file(status), path, ": is not a regular file but ", kind_of(status));
}

std::ifstream open_input(const std::string& path) {
  require_file(path);
  std::ifstream in(path, std::ios::binary);
  require(in.good(), path, ": cannot be opened: ", std::strerror(errno));
  std::string start(kMark.size(), '\0');
  in.read(start.data(), static_cast<std::streamsize>(start.size()));
  refuse_wide(path, start);
  in.clear();
  in.seekg(start == kMark ? static_cast<std::streamoff>(kMark.size()) : 0);
  return in;
}

std::string read_file(const std::string& path) {
  std::error_code error;
  require_file(path);
  const auto size = fs::file_size(path, error);
  require(!error, path, ": cannot be read: ", error.message());
  const Stream file = open(path);
  std::string content(size, '\0');
  require(std::fread(content.data(), 1, size, file.get()) == size, path,
          ": cannot be read: ", std::strerror(errno));
  if (content.starts_with(kMark)) content.erase(0, kMark.size());
  return content;
}

std::string read_text(const std::string& path) {
  std::string text = read_file(path);
  refuse_wide(path, text);
  return text;
}

std::string place_of_output(const std::string& path) {
  std::error_code error;
  require(!path.empty(), "'' is no name for a file");
  fs::path place = path;
  for (int links = 0; fs::is_symlink(place, error); ++links) {
    require(links < kMostLinks, path, ": is a link that leads back to itself");
    place = place.parent_path() / fs::read_symlink(place, error);
  }
  const fs::file_status status = fs::status(place, error);
  require(!fs::exists(status) || fs::is_regular_file(status), "'", path,
          "' is no name for a file: ", fs::is_directory(status) ? "a folder" : "a device, pipe or socket",
          " has it; give another one");
  const fs::path folder = place.parent_path();
  require(folder.empty() || fs::is_directory(folder, error), path, ": there is no folder ", folder.string());
  return place.string();
}

void put_in_place(const std::string& file, const std::string& path) {
  if (fs::is_directory(file)) return put_folder_in_place(file, path);
  const std::string place = place_of_output(path);
  const fs::path folder = fs::path(place).parent_path();
  int error = synchronised(file, O_RDONLY);
  if (error == 0 && std::rename(file.c_str(), place.c_str()) != 0) error = errno;
  if (error == EXDEV) error = moved_to_other_disk(file, place);
  if (error == 0) error = synchronised(folder.empty() ? "." : folder.string(), O_RDONLY | O_DIRECTORY);
  if (error != 0) fail_to_write(path, write_error(error));
}

PendingFile::PendingFile(std::string path) : path_(std::move(path)) {
  temporary_ = place_of_output(path_) + ".tmp" + std::to_string(getpid());
}

PendingFile::~PendingFile() {
  if (!committed_) std::remove(temporary_.c_str());
}

void PendingFile::commit() {
  put_in_place(temporary_, path_);
  committed_ = true;
}

void write_file(const std::string& path, std::string_view content) {
  PendingFile pending(path);
  Stream file = create(pending.temporary());
  const bool written = std::fwrite(content.data(), 1, content.size(), file.get()) == content.size();
  int error = written ? 0 : errno;
  if (std::fclose(file.release()) != 0 && written) error = errno;
  if (error != 0) fail_to_write(path, write_error(error));
  pending.commit();
}

}  // namespace elastogear
