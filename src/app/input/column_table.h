#pragma once
// Tables of numbers that users write: columns apart by commas or by blanks, with units in their heading.

#include <fstream>
#include <string>
#include <vector>

#include "elastogear/io/delimited_reader.h"

namespace elastogear::app {

/// Reads such a table line by line. Lines that begin with # are comments; the first line is the heading when
/// its first field is no number, "torque [kN m],revolutions". A number may have a unit of its own, too, in
/// tables with commas. Errors name file and line.
class ColumnTable {
 public:
  /// Throws Error when the file cannot be opened.
  explicit ColumnTable(const std::string& file);

  /// Moves to the next line of numbers; false at the end.
  bool next();
  std::size_t n_columns() const { return reader_.fields().size(); }
  /// A field of the line as it is written.
  std::string text(std::size_t column) const { return std::string(reader_.fields()[column]); }
  /// Finite number in `unit`, "N m"; "-": one without a unit.
  double number(std::size_t column, const std::string& unit) const;

  template <class... Parts>
  [[noreturn]] void fail_here(const Parts&... parts) const {
    reader_.fail_here(parts...);
  }

 private:
  std::ifstream in_;
  io::DelimitedReader reader_;
  std::vector<std::string> units_;  // of the columns, as the heading has them; empty: none
  bool started_ = false;
};

}  // namespace elastogear::app
