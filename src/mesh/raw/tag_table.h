#pragma once
// The numbers a file gives to its nodes or cells ("tags") and the 0-based numbers they get here.

#include <cstdint>
#include <string>
#include <vector>

namespace elastogear::mesh {

/// Number i belongs to the i-th smallest tag. `kind` ("node") and `source` (the file) name things in errors.
class TagTable {
 public:
  /// Error for tags below 1, repeated tags, or more than an int can number.
  TagTable(std::vector<std::int64_t> tags, std::string kind, std::string source);

  int size() const { return static_cast<int>(tags_.size()); }
  /// Number of a tag or -1.
  int find(std::int64_t tag) const;
  /// Number of a tag; Error "<user()> names node 17, which the file does not define".
  template <class User>
  int at(std::int64_t tag, const User& user) const {
    const int i = find(tag);
    if (i < 0) fail_unknown(tag, user());
    return i;
  }
  /// Tags in the order of their numbers.
  const std::vector<std::int64_t>& tags() const { return tags_; }
  /// Position in the constructor's argument of number i.
  int position(int i) const { return order_[i]; }

 private:
  [[noreturn]] void fail_unknown(std::int64_t tag, const std::string& user) const;

  std::vector<std::int64_t> tags_;  // ascending
  std::vector<int> order_;
  std::string kind_, source_;
};

}  // namespace elastogear::mesh
