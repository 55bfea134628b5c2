#pragma once
// Text of numbers, line by line through a buffer of fixed size.

#include <cstdint>
#include <istream>
#include <string>
#include <string_view>
#include <vector>

#include "elastogear/base/error.h"

namespace elastogear::io {

/// Lines split into fields. Errors name source and line.
class DelimitedReader {
 public:
  /// any: fields are apart by blanks and commas. one: by commas where the first line that is no comment has
  /// one, otherwise by blanks outside brackets, so that "100,5 1e6" is no line of three numbers.
  enum class Separator { any, one };

  DelimitedReader(std::istream& in, std::string source, Separator separator = Separator::any)
      : in_(&in), source_(std::move(source)), separator_(separator) {}
  DelimitedReader(const DelimitedReader&) = delete;
  DelimitedReader& operator=(const DelimitedReader&) = delete;

  /// Moves to the next line that is not blank and does not begin with one of the characters of `comment`;
  /// false at the end. Error for lines of more than 1023 characters.
  bool next(std::string_view comment);
  /// Fields of the current line.
  const std::vector<std::string_view>& fields() const { return fields_; }
  /// Finite number; Fortran's exponents (1.0D+3) are understood.
  double number(std::size_t field) const;
  /// Whole number of at least 1.
  std::int64_t count(std::size_t field) const;

  /// "torque.csv, line 3"
  std::string place() const { return source_ + ", line " + std::to_string(line_); }
  template <class... Parts>
  [[noreturn]] void fail_here(const Parts&... parts) const {
    fail(source_, ", line ", line_, ": ", parts...);
  }

 private:
  static constexpr int kBuffer = 1024;
  std::istream* in_;
  std::string source_;
  Separator separator_;
  bool by_commas_ = false, by_blanks_ = false;  // as the first line says, of `one`
  std::int64_t line_ = 0;
  char buffer_[kBuffer] = {};
  std::vector<std::string_view> fields_;
};

}  // namespace elastogear::io
