#pragma once
// Token by token through an MSH file: the same calls read numbers as text or as bytes.

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "elastogear/base/error.h"
#include "elastogear/base/number.h"

namespace elastogear::mesh {

class MshScanner {
 public:
  MshScanner(std::string path, std::string content) : path_(std::move(path)), text_(std::move(content)) {}

  void set_binary(bool binary) { binary_ = binary; }
  bool binary() const { return binary_; }

  /// After white space the end of the file?
  bool at_end();
  /// Next word between white space, always text.
  std::string_view word(const char* what);
  /// Rest of the line, always text.
  std::string_view line();
  /// "$EndNodes" and the like.
  void expect(std::string_view keyword);
  /// Jumps behind `keyword`.
  void skip_past(const std::string& keyword);

  int integer(const char* what) { return number<std::int32_t>(what); }
  double real(const char* what);
  /// A tag: a size_t of the format, here as a signed number.
  std::int64_t tag(const char* what);
  /// A count of things still to come, which take at least `bytes_each`: a larger count is an error.
  std::size_t count(const char* what, std::size_t bytes_each = 1);

  template <class... Parts>
  [[noreturn]] void fail_here(const Parts&... parts) const {
    fail(path_, ", ", place(), ": ", parts...);
  }

  template <class T>
  T text_number(const char* what) {
    const std::string_view token = word(what);
    const auto value = parse<T>(token);
    if (!value) fail_here(what, " is '", token.substr(0, 40), "', must be a number");
    return *value;
  }
  /// sizeof(T) bytes, whatever the encoding.
  template <class T>
  T bytes(const char* what) {
    T value;
    if (text_.size() - position_ < sizeof(T)) fail_here("the file ends where ", what, " is expected");
    std::memcpy(&value, text_.data() + position_, sizeof(T));
    position_ += sizeof(T);
    return value;
  }

 private:
  std::string place() const;  // "line 12" or "byte 3456"
  template <class T>
  T number(const char* what) {
    return binary_ ? bytes<T>(what) : text_number<T>(what);
  }

  std::string path_, text_;
  std::size_t position_ = 0;
  bool binary_ = false;
};

}  // namespace elastogear::mesh
