#include "mesh/raw/tag_table.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "elastogear/base/error.h"

namespace elastogear::mesh {

TagTable::TagTable(std::vector<std::int64_t> tags, std::string kind, std::string source)
    : tags_(std::move(tags)), kind_(std::move(kind)), source_(std::move(source)) {
  require(tags_.size() <= std::numeric_limits<int>::max() / 8, source_, ": too many ", kind_,
          "s: ", tags_.size());
  order_.resize(tags_.size());
  std::iota(order_.begin(), order_.end(), 0);
  if (!std::is_sorted(tags_.begin(), tags_.end())) {
    std::stable_sort(order_.begin(), order_.end(), [&](int a, int b) { return tags_[a] < tags_[b]; });
    std::sort(tags_.begin(), tags_.end());
  }
  if (tags_.empty()) return;
  require(tags_.front() >= 1, source_, ": ", kind_, " number ", tags_.front(), ", must be at least 1");
  const auto twin = std::adjacent_find(tags_.begin(), tags_.end());
  require(twin == tags_.end(), source_, ": ", kind_, " ", twin == tags_.end() ? 0 : *twin,
          " is defined twice");
}

int TagTable::find(std::int64_t tag) const {
  if (tags_.empty() || tag < tags_.front() || tag > tags_.back()) return -1;
  // Numbering without gaps is the rule and needs no search.
  const auto guess = static_cast<std::size_t>(tag - tags_.front());
  if (guess < tags_.size() && tags_[guess] == tag) return static_cast<int>(guess);
  const auto found = std::lower_bound(tags_.begin(), tags_.end(), tag);
  return *found == tag ? static_cast<int>(found - tags_.begin()) : -1;
}

void TagTable::fail_unknown(std::int64_t tag, const std::string& user) const {
  fail(source_, ": ", user, " names ", kind_, " ", tag, ", which the file does not define");
}

}  // namespace elastogear::mesh
