#pragma once
// Line by line through an Abaqus input file and the files it includes.

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "elastogear/base/error.h"
#include "elastogear/base/number.h"
#include "mesh/inp/lines/inp.h"
#include "mesh/inp/lines/inp_keywords.h"

namespace elastogear::mesh {

std::string upper(std::string_view text);

/// "*ELEMENT, TYPE=C3D8" without the star: name and parameters in capitals, values as written.
struct Keyword {
  std::string name;
  const KeywordRow* row = nullptr;  ///< null: a keyword that nobody knows
  std::map<std::string, std::string> parameters;
  int line = 0;

  bool has(const std::string& parameter) const { return parameters.contains(parameter); }
  /// Value in capitals, or empty.
  std::string value(const std::string& parameter) const;
};

/// Lines are numbered through all files in the order they are read; place() tells file and line. *INCLUDE is
/// followed wherever it stands. Views and references are valid as long as the object.
class InpLines {
 public:
  explicit InpLines(InpText text);
  InpLines(const InpLines&) = delete;
  InpLines& operator=(const InpLines&) = delete;

  /// Moves to the next line that is no comment and not blank; false at the end of all files.
  bool next();
  int number() const { return number_; }
  const std::string& path() const { return files_.front().path; }
  std::size_t total_size() const;  ///< of all files so far, bytes
  /// "line 12" of the first file or "part.inp, line 3" of an included one.
  std::string place(int number) const;
  /// Is the current line a keyword line?
  bool at_keyword() const { return line_.starts_with('*'); }
  /// The current keyword line with its continuation lines. A comma at the end of a line goes on only where
  /// the next line holds parameters.
  Keyword keyword();
  /// Puts the content of the file that parameter INPUT names in front of the data lines that follow.
  void include(const Keyword& key);
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
  /// A finite number, with Fortran's exponent letter D too.
  double real(std::string_view field, const char* what) const;
  /// The current line's fields as finite numbers; empty fields are 0.
  std::vector<double> reals(const char* what);

  template <class... Parts>
  [[noreturn]] void fail_here(const Parts&... parts) const {
    fail_at(number_, parts...);
  }
  template <class... Parts>
  [[noreturn]] void fail_at(int number, const Parts&... parts) const {
    const auto [file, line] = locate(number);
    fail(file->path, ", line ", line, ": ", parts...);
  }

 private:
  struct File {
    std::string path, text;
    std::size_t position = 0;
    int lines = 0;
  };
  struct Location {
    const File* file;
    int line;
  };
  struct Segment {
    int first;  // number of the first line
    Location location;
  };
  struct Line {
    std::string_view text;
    int number;
  };

  void add_parameter(Keyword& keyword, std::string_view text) const;
  bool next_line();
  void enter(File& file);
  void include_line();
  void return_to(std::string_view line, int number);
  bool holds_parameters(const Keyword& keyword) const;
  Location locate(int number) const;

  std::deque<File> files_;  // all, the first is the one that includes the others
  std::vector<File*> open_;
  std::vector<Segment> segments_;
  std::function<std::string(const std::string&)> open_file_;
  int number_ = 0;
  std::string_view line_;
  std::optional<Line> ahead_;  // seen by next_data() and left for next()
  std::vector<std::string_view> fields_;
};

}  // namespace elastogear::mesh
