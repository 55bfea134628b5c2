#pragma once
// The folder in which a result grows: `path`.partial with part_000000.h5, part_000001.h5, ... (the histories,
// cut along the time) and state.h5, which says how many parts count and from which state a run can go on
// after them. A kill at any moment leaves whole files only. Private to module io.

#include <string>
#include <vector>

#include "io/result/result_rows.h"

namespace elastogear::io {

class ResultParts {
 public:
  /// goes_on: keeps the parts that state.h5 counts; everything else of ours in the folder is removed. Error
  /// when the folder cannot be made.
  ResultParts(const std::string& result, bool goes_on);

  /// Rows of the parts that an earlier run left.
  const RowCount& count() const { return count_; }
  int size() const { return n_parts_; }
  std::string path_of_next() const;
  /// The next part has appeared under its name.
  void add() { ++n_parts_; }
  /// The last checkpoint: after all parts so far.
  void write_state(const std::vector<double>& state, const RowCount& count) const;
  /// Appends the histories of all parts to a file with a header. Error when they do not follow each other.
  void append_to(const h5::File& out) const;
  /// Puts a file (a path in the folder) in the result's place.
  void publish(const std::string& file) const;
  std::string path(const std::string& file) const;
  void remove() const;
  /// The folder, unless there are files in it.
  void remove_if_empty() const;

 private:
  void make_folder() const;

  std::string result_, folder_;
  int n_parts_ = 0;
  RowCount count_;
};

/// Root attribute of the parts after the first: number of output times before them.
constexpr const char* kTimesBefore = "times_before";

}  // namespace elastogear::io
