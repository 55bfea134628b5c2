#pragma once
// Whole files read at once, and files that appear under their name only when complete.

#include <string>
#include <string_view>

#include "elastogear/base/error.h"

namespace elastogear {

/// A file could not be written, for example because its disk is full.
class WriteFailure : public Error {
 public:
  using Error::Error;
};

/// Throws WriteFailure: "PATH: cannot be written: REASON".
[[noreturn]] void fail_to_write(const std::string& path, const std::string& reason);
/// The reason that an errno of a write stands for, with the remedy.
std::string write_error(int error);

/// Is there a regular file of this name? No error for what is too long, or out of reach, to be one.
bool is_file(const std::string& path);
/// The whole content of a regular file; Error naming the path and the reason.
std::string read_file(const std::string& path);

/// A file that is written under a temporary name beside `path` and takes its place by commit(), so that a
/// killed or failed run leaves the old file or none. Destroyed uncommitted: the temporary is removed.
class PendingFile {
 public:
  /// Error when `path` is a directory or its folder does not exist.
  explicit PendingFile(std::string path);
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  const std::string& path() const { return path_; }
  const std::string& temporary() const { return temporary_; }
  /// Renames the (closed) temporary to path().
  void commit();

 private:
  std::string path_, temporary_;
  bool committed_ = false;
};

/// Writes `content` to `path` by way of a PendingFile. WriteFailure when it cannot.
void write_file(const std::string& path, std::string_view content);

}  // namespace elastogear
