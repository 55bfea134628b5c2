#pragma once
// Line by line through an Abaqus input file.

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "elastogear/base/error.h"
#include "elastogear/base/number.h"

namespace elastogear::mesh {

std::string upper(std::string_view text);

/// "*ELEMENT, TYPE=C3D8" without the star: name and parameters in capitals, values as written.
struct Keyword {
  std::string name;
  std::map<std::string, std::string> parameters;
  int line = 0;

  bool has(const std::string& parameter) const { return parameters.contains(parameter); }
};

class InpLines {
 public:
  InpLines(std::string path, std::string content) : path_(std::move(path)), text_(std::move(content)) {}

  /// Moves to the next line that is no comment and not blank; false at the end of the file.
  bool next();
  int number() const { return number_; }
  const std::string& path() const { return path_; }
  /// Is the current line a keyword line?
  bool at_keyword() const { return line_.starts_with('*'); }
  /// The current keyword line with its continuation lines.
  Keyword keyword();
  /// Next line that is data; false (and nothing consumed) at a keyword or the end.
  bool next_data();
  /// Does the current line end with a comma?
  bool continues() const { return line_.ends_with(','); }
  /// The current data line's fields without surrounding blanks; a trailing comma adds no field.
  const std::vector<std::string_view>& fields();

  template <class T>
  T parse_field(std::string_view field, const char* what) const {
    const auto value = parse<T>(field);
    if (!value) fail_here(what, " is '", field.substr(0, 40), "', must be a number");
    return *value;
  }
  template <class... Parts>
  [[noreturn]] void fail_here(const Parts&... parts) const {
    fail_at(number_, parts...);
  }
  template <class... Parts>
  [[noreturn]] void fail_at(int line, const Parts&... parts) const {
    fail(path_, ", line ", line, ": ", parts...);
  }

 private:
  void add_parameter(Keyword& keyword, std::string_view text) const;

  std::string path_, text_;
  std::size_t position_ = 0;
  int number_ = 0;
  std::string_view line_;
  std::vector<std::string_view> fields_;
};

}  // namespace elastogear::mesh
