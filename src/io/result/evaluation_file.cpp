#include "elastogear/io/evaluation_file.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <set>

#include "elastogear/base/file.h"
#include "io/hdf5/schema.h"

namespace elastogear::io {
namespace {

constexpr const char* kCases = "/cases";
constexpr int kDeepest = 8;  // groups

std::size_t size_of(const std::vector<std::size_t>& shape) {
  return std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
}

void check_item(const h5::File& file, const EvaluationItem& item) {
  require(!item.path.empty() && item.path.front() != '/' && item.path.back() != '/', file.path, ": '",
          item.path, "' is no path of an item");
  if (!item.words.empty()) return;
  require(item.value.size() == size_of(item.shape), file.path, ": ", item.path, " has ", item.value.size(),
          " numbers, its shape holds ", size_of(item.shape));
  require(std::all_of(item.value.begin(), item.value.end(), [](double v) { return std::isfinite(v); }),
          file.path, ": ", item.path, " is not finite");
}

void write_item(const h5::File& file, const EvaluationItem& item) {
  const std::string name = std::string(kCases) + "/" + item.path;
  if (!item.words.empty())
    h5::write_strings(file, name, item.words);
  else
    h5::write<double>(file, name, {h5::Shape(item.shape.begin(), item.shape.end()), item.value.data()},
                      item.unit);
  h5::set_attribute(file, name, "meaning", item.meaning);
}

EvaluationItem read_item(const h5::File& file, const std::string& name) {
  EvaluationItem item{.path = name.substr(std::string(kCases).size() + 1),
                      .unit = h5::unit(file, name),
                      .meaning = h5::string_attribute(file, name, "meaning")};
  const h5::Shape shape = h5::shape(file, name);
  item.shape.assign(shape.begin(), shape.end());
  if (h5::holds_text(file, name))
    item.words = h5::read_strings(file, name);
  else
    item.value = h5::read<double>(file, name, h5::Shape(shape.size(), h5::kAny));
  return item;
}

// Links may lead back to a group above: the depth has an end.
void read_below(const h5::File& file, const std::string& name, int depth,
                std::vector<EvaluationItem>& items) {
  require(depth > 0, file.path, ": ", name, " lies too deep below ", kCases);
  if (!h5::is_group(file, name)) return items.push_back(read_item(file, name));
  for (const std::string& member : h5::members(file, name))
    read_below(file, std::string(name).append("/").append(member), depth - 1, items);
}

}  // namespace

void write_evaluation(const std::string& path, const EvaluationFile& evaluation) {
  PendingFile pending(path);
  h5::File file = h5::create(path, pending.temporary());
  write_format(file, kEvaluationFormat);
  h5::write_map(file, "/provenance", evaluation.provenance);
  h5::make_group(file, kCases);
  std::set<std::string> paths;
  for (const EvaluationItem& item : evaluation.items) {
    check_item(file, item);
    require(paths.insert(item.path).second, path, ": ", item.path, " is there twice");
    write_item(file, item);
  }
  h5::close(file);
  pending.commit();
}

EvaluationFile read_evaluation(const std::string& path) {
  const h5::File file = open_format(path, kEvaluationFormat);
  EvaluationFile evaluation;
  evaluation.provenance = h5::read_map(file, "/provenance");
  read_below(file, kCases, kDeepest, evaluation.items);
  return evaluation;
}

}  // namespace elastogear::io
