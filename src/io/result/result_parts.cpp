#include "io/result/result_parts.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "elastogear/base/file.h"
#include "elastogear/io/result_file.h"
#include "io/hdf5/schema.h"

namespace elastogear::io {
namespace {

namespace fs = std::filesystem;

// Parts of older versions lack what those of this one have.
constexpr Format kStateFormat{"elastogear state", 6, 6};
constexpr const char* kStateFile = "state.h5";
constexpr const char* kPartPrefix = "part_";
constexpr hsize_t kNumbersAtOnce = 1 << 20;

std::string folder_of(const std::string& result) { return result + ".partial"; }
std::string state_path(const std::string& result) {
  return (fs::path(folder_of(result)) / kStateFile).string();
}

std::string part_name(int i) {
  char name[32];
  std::snprintf(name, sizeof name, "%s%06d.h5", kPartPrefix, i);
  return name;
}

struct StoredState {
  int n_parts;
  RowCount count;
  std::vector<double> state;
};

StoredState read_state(const std::string& result) {
  const h5::File file = open_format(state_path(result), kStateFormat);
  return {h5::int_attribute(file, "/", "parts").front(),
          {h5::number_attribute(file, "/", "last_time"), h5::int_attribute(file, "/", "times").front(),
           h5::read<double>(file, "/contacts", {h5::kAny}), h5::read<double>(file, "/forces", {h5::kAny})},
          h5::read<double>(file, "/state", {h5::kAny}, h5::Finite::any)};
}

// Deletes what this program put into the folder, but for the state and the first n_kept parts.
void tidy(const std::string& folder, int n_kept) {
  std::error_code error;
  std::vector<fs::path> doomed;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    const bool temporary = name.find(".h5.tmp") != std::string::npos;
    const bool part = name.starts_with(kPartPrefix) && name.ends_with(".h5");
    if (temporary || (part && name >= part_name(n_kept)) || (n_kept == 0 && name == kStateFile))
      doomed.push_back(entry.path());
  }
  for (const fs::path& path : doomed) fs::remove(path, error);
}

bool is_history(hid_t object) {
  if (H5Iget_type(object) != H5I_DATASET) return false;
  const h5::Id type(H5Dget_type(object));
  return H5Tget_class(type) != H5T_STRING;
}

// All datasets of numbers below a group.
void find_histories(const h5::File& file, const std::string& group, std::vector<std::string>& names) {
  for (const std::string& member : h5::members(file, group)) {
    const std::string name = (group == "/" ? "" : group) + "/" + member;
    const h5::Id object(H5Oopen(file.id, name.c_str(), H5P_DEFAULT));
    if (object < 0) h5::damaged(file, "header of " + name);
    if (H5Iget_type(object) == H5I_GROUP) find_histories(file, name, names);
    if (is_history(object)) names.push_back(name);
  }
}

h5::Item item_of(const h5::File& file, const std::string& name) {
  h5::Shape item = h5::shape(file, name);
  item.erase(item.begin());
  const h5::Id dataset(H5Dopen2(file.id, name.c_str(), H5P_DEFAULT)), type(H5Dget_type(dataset));
  return {item, h5::unit(file, name), H5Tget_class(type) == H5T_INTEGER};
}

void copy_rows(const h5::File& part, const std::string& name, h5::Series& series) {
  h5::Shape count = h5::shape(part, name);
  const hsize_t n_rows = count[0];
  count[0] = 1;
  hsize_t row_size = 1;
  for (hsize_t n : count) row_size *= n;
  const hsize_t at_once = std::max<hsize_t>(1, kNumbersAtOnce / std::max<hsize_t>(row_size, 1));
  for (hsize_t first = 0; first < n_rows; first += at_once) {
    count[0] = std::min(at_once, n_rows - first);
    std::vector<double> rows(count[0] * row_size);
    if (!rows.empty()) h5::read_rows(part, name, {first, count}, rows.data());
    series.append(rows.data(), count[0]);
  }
}

}  // namespace

ResultParts::ResultParts(const std::string& result, bool goes_on)
    : result_(result), folder_(folder_of(result)) {
  if (goes_on) {
    StoredState stored = read_state(result);
    n_parts_ = stored.n_parts;
    count_ = std::move(stored.count);
  }
  tidy(folder_, n_parts_);
  make_folder();
}

void ResultParts::make_folder() const {
  std::error_code error;
  fs::create_directories(folder_, error);
  require(!error, folder_, ": the folder for parts of the result cannot be made: ", error.message());
}

std::string ResultParts::path(const std::string& file) const { return (fs::path(folder_) / file).string(); }
std::string ResultParts::path_of_next() const { return path(part_name(n_parts_)); }

void ResultParts::write_state(const std::vector<double>& state, const RowCount& count) const {
  PendingFile pending(state_path(result_));
  h5::File file = h5::create(pending.path(), pending.temporary());
  write_format(file, kStateFormat);
  h5::set_attribute(file, "/", "parts", n_parts_);
  h5::set_attribute(file, "/", "times", count.times);
  h5::set_attribute(file, "/", "last_time", count.last_time);
  h5::write<double>(file, "/contacts", {{count.contacts.size()}, count.contacts.data()}, "1");
  h5::write<double>(file, "/forces", {{count.forces.size()}, count.forces.data()}, "1");
  h5::write<double>(file, "/state", {{state.size()}, state.data()}, "1");
  h5::close(file);
  pending.commit();
}

void ResultParts::append_to(const h5::File& out) const {
  std::map<std::string, h5::Series> series;
  int n_times = 0;
  for (int i = 0; i < n_parts_; ++i) {
    const h5::File part = open_format(path(part_name(i)), kResultFormat);
    require(n_times == 0 || h5::int_attribute(part, "/", kTimesBefore).front() == n_times, part.path,
            ": does not follow the part before: did two runs write to one result?");
    std::vector<std::string> names;
    find_histories(part, "/", names);
    for (const std::string& name : names)
      copy_rows(part, name, series.try_emplace(name, out, name, item_of(part, name)).first->second);
    if (!names.empty()) n_times += static_cast<int>(h5::shape(part, "/time")[0]);
  }
  for (auto& [name, rows] : series) rows.flush();
}

void ResultParts::publish(const std::string& file) const { put_in_place(file, result_); }

void ResultParts::remove() const {
  std::error_code error;
  tidy(folder_, 0);
  fs::remove(folder_, error);  // fails when it holds other files
}

void ResultParts::remove_if_empty() const {
  std::error_code error;
  fs::remove(folder_, error);  // fails when it is not
}

std::optional<UnfinishedRun> read_unfinished_run(const std::string& path) {
  if (!fs::exists(state_path(path))) return {};
  StoredState stored = read_state(path);
  const h5::File first = open_format((fs::path(folder_of(path)) / part_name(0)).string(), kResultFormat);
  return UnfinishedRun{h5::read_map(first, "/provenance"), std::move(stored.state), stored.count.last_time};
}

}  // namespace elastogear::io
