#include "elastogear/base/file.h"

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

Stream open(const std::string& path, const char* mode) {
  Stream file(std::fopen(path.c_str(), mode));
  require(file != nullptr, path, ": cannot be opened: ", std::strerror(errno));
  return file;
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

std::string read_file(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  require(std::filesystem::exists(status), path, ": there is no such file");
  require(std::filesystem::is_regular_file(status), path, ": is not a regular file");
  const auto size = std::filesystem::file_size(path, error);
  require(!error, path, ": cannot be read: ", error.message());
  const Stream file = open(path, "rb");
  std::string content(size, '\0');
  require(std::fread(content.data(), 1, size, file.get()) == size, path,
          ": cannot be read: ", std::strerror(errno));
  return content;
}

PendingFile::PendingFile(std::string path) : path_(std::move(path)) {
  namespace fs = std::filesystem;
  std::error_code error;
  require(!path_.empty() && !fs::is_directory(path_, error), "'", path_, "' is no name for a file");
  const fs::path folder = fs::path(path_).parent_path();
  require(folder.empty() || fs::is_directory(folder, error), path_, ": there is no folder ", folder.string());
  temporary_ = path_ + ".tmp" + std::to_string(getpid());
}

PendingFile::~PendingFile() {
  if (!committed_) std::remove(temporary_.c_str());
}

void PendingFile::commit() {
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0) fail_to_write(path_, write_error(errno));
  committed_ = true;
}

void write_file(const std::string& path, std::string_view content) {
  PendingFile pending(path);
  Stream file = open(pending.temporary(), "wb");
  const bool written = std::fwrite(content.data(), 1, content.size(), file.get()) == content.size();
  int error = written ? 0 : errno;
  if (std::fclose(file.release()) != 0 && written) error = errno;
  if (error != 0) fail_to_write(path, write_error(error));
  pending.commit();
}

}  // namespace elastogear
