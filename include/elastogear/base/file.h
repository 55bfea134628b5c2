#pragma once
// Whole files read at once, and files that appear under their name only when complete.

#include <fstream>
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

/// Where a file of this name is written: links are followed, also to files that do not exist yet. Error where
/// a folder, device, pipe or socket stands, which a file must not replace, and where its folder is missing.
std::string place_of_output(const std::string& path);

/// Gives a complete, closed file its name. What it holds is on the disk before the name is, so that a loss of
/// power leaves the old file or the new one. Of a folder, whose files are on the disk already, the name alone
/// changes; what has the new name goes. WriteFailure when it cannot.
void put_in_place(const std::string& file, const std::string& path);

/// Error naming the path, and what has it in place of a regular file: nothing, a folder, a device, a pipe or
/// a socket. The latter may have no end.
void require_file(const std::string& path);

/// A file of text, to be read from its beginning, behind the byte order mark of UTF-8 that some programs
/// write there; Error naming the path and the reason, also of text in UTF-16.
std::ifstream open_input(const std::string& path);
/// The whole content of a file without that mark.
std::string read_file(const std::string& path);
/// The same of a file of text; Error for text in UTF-16.
std::string read_text(const std::string& path);

/// A file that is written under a temporary name beside `path`, or beside the file that the link `path` leads
/// to, and takes its place by commit(), so that a killed or failed run leaves the old file or none. Destroyed
/// uncommitted: the temporary is removed.
class PendingFile {
 public:
  /// Errors of place_of_output().
  explicit PendingFile(std::string path);
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  const std::string& path() const { return path_; }
  const std::string& temporary() const { return temporary_; }
  /// Puts the (closed) temporary in place.
  void commit();

 private:
  std::string path_, temporary_;
  bool committed_ = false;
};

/// Writes `content` to `path` by way of a PendingFile. WriteFailure when it cannot.
void write_file(const std::string& path, std::string_view content);

}  // namespace elastogear
