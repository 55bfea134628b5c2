#include "mesh/inp/lines/inp_sets.h"

#include <algorithm>
#include <utility>

#include "elastogear/base/sort_unique.h"
#include "mesh/inp/lines/inp_lines.h"

namespace elastogear::mesh {
namespace {

constexpr int kMaxDepth = 100;  // of sets within sets

// Sorts out repeated members once there are more than `most`.
void compact(std::vector<int>& members, std::size_t most) {
  if (members.size() > most) sort_unique(members);
}

}  // namespace

const std::string& InpNames::first_spelling(const std::string& name) {
  return spelling.try_emplace(upper(name), name).first->second;
}

void InpSets::add(const std::string& name, const std::vector<std::int64_t>& tags, int line) {
  names_.first_spelling(name);
  Set& set = sets_[upper(name)];
  for (std::int64_t tag : tags) {
    // Consecutive numbers are the rule in big files: keep them as one range.
    if (!set.ranges.empty() && set.ranges.back().step == 1 && set.ranges.back().last < tag &&
        set.ranges.back().last == tag - 1) {
      set.ranges.back().last = tag;
    } else {
      set.ranges.push_back({tag, tag, 1, line});
    }
  }
}

void InpSets::add_range(const std::string& name, std::int64_t first, std::int64_t last, std::int64_t step,
                        int line) {
  add(name, {}, line);
  sets_[upper(name)].ranges.push_back({first, last, step, line});
}

void InpSets::add_set(const std::string& name, const std::string& member, int line) {
  add(name, {}, line);
  sets_[upper(name)].references.push_back({upper(member), line});
}

const std::string* InpSets::spelling(const std::string& name) const {
  const auto found = names_.spelling.find(upper(name));
  return found == names_.spelling.end() ? nullptr : &found->second;
}

struct InpSets::Resolution {
  const InpSets& sets;
  const Context& context;
  std::map<std::string, std::vector<int>> members = {};  // by name in capitals
  std::map<std::string, Mark> marks = {};

  void add_range(const Range& range, const std::string& set, std::vector<int>& out) const {
    for (std::int64_t tag = range.first; tag <= range.last; tag += range.step) {
      const int i = context.table.find(tag);
      if (i < 0 && !(context.left_out && context.left_out->find(tag) >= 0))
        context.fail_at(range.line, sets.kind_ + " set '" + *sets.spelling(set) + "' names " + sets.kind_ +
                                        " " + std::to_string(tag) + ", which the file does not define");
      if (i >= 0) out.push_back(i);
      // The difference of two integers may be none.
      if (static_cast<std::uint64_t>(range.step) >
          static_cast<std::uint64_t>(range.last) - static_cast<std::uint64_t>(tag))
        break;
    }
  }

  const std::vector<int>& resolve(const std::string& name, int line, int depth = 0) {
    if (depth > kMaxDepth)
      context.fail_at(line, "sets are nested more than " + std::to_string(kMaxDepth) + " deep");
    const auto found = sets.sets_.find(name);
    if (found == sets.sets_.end()) context.fail_at(line, "unknown " + sets.kind_ + " set '" + name + "'");
    const auto [mark, fresh] = marks.try_emplace(name, Mark::open);
    if (!fresh && mark->second == Mark::open)
      context.fail_at(line, sets.kind_ + " set '" + name + "' contains itself");
    std::vector<int>& out = members[name];
    if (!fresh) return out;
    for (const Range& range : found->second.ranges) {
      add_range(range, name, out);
      compact(out, 2 * static_cast<std::size_t>(context.table.size()));
    }
    for (const Reference& reference : found->second.references) {
      const std::vector<int>& others = resolve(reference.set, reference.line, depth + 1);
      out.insert(out.end(), others.begin(), others.end());
      compact(out, 2 * static_cast<std::size_t>(context.table.size()));
    }
    compact(out, 0);
    context.budget.spend(out.size());
    mark->second = Mark::done;
    return out;
  }
};

std::map<std::string, std::vector<int>> InpSets::resolve(const Context& context) const {
  Resolution resolution{*this, context};
  std::map<std::string, std::vector<int>> result;
  for (const auto& [name, set] : sets_) result[*spelling(name)] = resolution.resolve(name, 0);
  return result;
}

}  // namespace elastogear::mesh
