#pragma once
// The node or element sets of an Abaqus input file, which may name numbers, ranges and other sets.

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "mesh/raw/raw_mesh.h"

namespace elastogear::mesh {

/// Names that match without regard to case.
struct InpNames {
  std::map<std::string, std::string> spelling;  ///< in capitals -> as first written

  const std::string& first_spelling(const std::string& name);
};

class InpSets {
 public:
  explicit InpSets(std::string kind) : kind_(std::move(kind)) {}

  /// Adds members to a set; `line` is named in errors.
  void add(const std::string& name, const std::vector<std::int64_t>& tags, int line);
  void add_range(const std::string& name, std::int64_t first, std::int64_t last, std::int64_t step, int line);
  void add_set(const std::string& name, const std::string& member, int line);

  /// First spelling of a set's name or null.
  const std::string* spelling(const std::string& name) const;

  struct Context {
    const TagTable& table;
    const TagTable* left_out = nullptr;  ///< defined in the file, but not in the table
    MemberBudget& budget;
    std::function<void(int line, const std::string& text)> fail_at;  ///< must throw
  };
  /// Sorted 0-based members by name, without those left out. Sets may be named before they are defined.
  std::map<std::string, std::vector<int>> resolve(const Context& context) const;

 private:
  struct Range {
    std::int64_t first, last, step;
    int line;
  };
  struct Reference {
    std::string set;  // in capitals
    int line;
  };
  struct Set {
    std::vector<Range> ranges;
    std::vector<Reference> references;
  };
  enum class Mark { open, done };
  struct Resolution;

  std::string kind_;
  InpNames names_;
  std::map<std::string, Set> sets_;  // by name in capitals
};

}  // namespace elastogear::mesh
