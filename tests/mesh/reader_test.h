#pragma once
// A mesh reader on texts: a sample, and what the reader says when a part of it is replaced.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "box_mesh.h"
#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "elastogear/mesh/file.h"

namespace elastogear::mesh {

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

struct ReaderTest : testing::Test {
  /// `file`: name whose extension chooses the reader.
  ReaderTest(const std::string& file, std::string text) : sample(std::move(text)), path(folder / file) {}

  Folder folder{"reader"};
  std::string sample, path;

  Mesh read(const std::string& content, ReadReport* report = nullptr) const {
    write_file(path, content);
    return read_mesh(path, 1, report);
  }
  std::string error_of(const std::string& content) const {
    try {
      read(content);
    } catch (const Error& e) {
      return e.what();
    }
    return "no error";
  }
  /// Of the sample with `to` in place of `from`.
  std::string error(const std::string& from, const std::string& to) const {
    return error_of(replaced(sample, from, to));
  }
};

}  // namespace elastogear::mesh
