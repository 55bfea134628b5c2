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
  require(std::rename(temporary_.c_str(), path_.c_str()) == 0, path_,
          ": cannot be written: ", std::strerror(errno));
  committed_ = true;
}

void write_file(const std::string& path, std::string_view content) {
  PendingFile pending(path);
  Stream file = open(pending.temporary(), "wb");
  const bool written = std::fwrite(content.data(), 1, content.size(), file.get()) == content.size();
  const bool closed = std::fclose(file.release()) == 0;
  require(written && closed, path, ": cannot be written: ", std::strerror(errno));
  pending.commit();
}

}  // namespace elastogear
