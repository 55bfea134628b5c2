#include "elastogear/io/checkpoint_store.h"

#include <algorithm>
#include <filesystem>
#include <map>

#include "elastogear/base/file.h"
#include "io/hdf5/schema.h"

namespace elastogear::io {
namespace {

namespace fs = std::filesystem;

constexpr Format kCheckpointFormat{"elastogear piece"};
constexpr const char* kExtension = ".h5";

// The fingerprint of a whole checkpoint, or nothing.
std::string fingerprint_of(const std::string& path) {
  try {
    return h5::string_attribute(open_format(path, kCheckpointFormat), "/", "fingerprint");
  } catch (const Error&) {
    return {};
  }
}

// Returns whether a file is a whole one of another kind: runs and sweeps that did not end have such folders,
// too.
bool is_foreign(const std::string& path) {
  try {
    return h5::string_attribute(h5::open(path), "/", "format") != kCheckpointFormat.name;
  } catch (const Error&) {
    return false;
  }
}

// Returns whether a file is one that a killed run left under a temporary name (base/file.h).
bool is_temporary(const fs::path& path) {
  return path.filename().string().find(".h5.tmp") != std::string::npos;
}

}  // namespace

CheckpointStore::CheckpointStore(std::string folder, std::string fingerprint)
    : folder_(std::move(folder)), fingerprint_(std::move(fingerprint)) {
  std::error_code error;
  std::vector<fs::path> doomed;
  for (const auto& entry : fs::directory_iterator(folder_, error)) {
    const fs::path& path = entry.path();
    if (is_temporary(path)) doomed.push_back(path);
    if (path.extension() != kExtension || is_foreign(path.string())) continue;
    if (fingerprint_of(path.string()) == fingerprint_) {
      names_.push_back(path.stem().string());
    } else {
      doomed.push_back(path);
      ++discarded_;
    }
  }
  for (const fs::path& path : doomed) fs::remove(path, error);
  std::sort(names_.begin(), names_.end());
}

void CheckpointStore::add(const std::string& name) {
  names_.insert(std::lower_bound(names_.begin(), names_.end(), name), name);
}

std::string CheckpointStore::path(const std::string& name) const {
  return (fs::path(folder_) / (name + kExtension)).string();
}

void CheckpointStore::clear() {
  std::error_code error;
  for (const std::string& name : names_) fs::remove(path(name), error);
  names_.clear();
  fs::remove(folder_, error);  // fails when it is not empty
}

struct CheckpointWriter::Data {
  CheckpointStore& store;
  std::string name;
  PendingFile pending;
  h5::File file;
  std::map<std::string, h5::Series> series;
};

CheckpointWriter::CheckpointWriter(CheckpointStore& store, const std::string& name) {
  std::error_code error;
  fs::create_directories(store.folder(), error);
  require(!error, store.folder(), ": the folder for parts of the result cannot be made: ", error.message());
  data_.reset(new Data{store, name, PendingFile(store.path(name)), {}, {}});
  data_->file = h5::create(data_->pending.path(), data_->pending.temporary());
  write_format(data_->file, kCheckpointFormat);
  h5::set_attribute(data_->file, "/", "fingerprint", store.fingerprint());
}

CheckpointWriter::~CheckpointWriter() = default;

void CheckpointWriter::write(const std::string& array, const Eigen::MatrixXd& values) {
  const h5::Shape shape{static_cast<hsize_t>(values.cols()), static_cast<hsize_t>(values.rows())};
  h5::write<double>(data_->file, "/" + array, {shape, values.data()}, "1");
}

void CheckpointWriter::append(const std::string& array, const Eigen::VectorXd& row, Precision precision) {
  auto found = data_->series.find(array);
  if (found == data_->series.end()) {
    const h5::Item item{{static_cast<hsize_t>(row.size())}, "1", false, precision == Precision::float32};
    found = data_->series.emplace(array, h5::Series(data_->file, "/" + array, item)).first;
  }
  found->second.append(row.data());
}

void CheckpointWriter::commit() {
  for (auto& [name, series] : data_->series) series.flush();
  data_->series.clear();
  h5::close(data_->file);
  data_->pending.commit();
  data_->store.add(data_->name);
}

struct CheckpointReader::Data {
  h5::File file;
};

CheckpointReader::CheckpointReader(const CheckpointStore& store, const std::string& name)
    : data_(new Data{open_format(store.path(name), kCheckpointFormat)}) {}

CheckpointReader::~CheckpointReader() = default;

bool CheckpointReader::has(const std::string& array) const { return h5::exists(data_->file, "/" + array); }

Eigen::MatrixXd CheckpointReader::read(const std::string& array) const {
  const h5::Shape shape = h5::shape(data_->file, "/" + array);
  // The end of a search that found all there is is infinite.
  const auto values = h5::read<double>(data_->file, "/" + array, {h5::kAny, h5::kAny}, h5::Finite::any);
  return Eigen::Map<const Eigen::MatrixXd>(values.data(), static_cast<Eigen::Index>(shape[1]),
                                           static_cast<Eigen::Index>(shape[0]));
}

int CheckpointReader::n_rows(const std::string& array) const {
  return static_cast<int>(h5::shape(data_->file, "/" + array).at(0));
}

Eigen::VectorXd CheckpointReader::read_row(const std::string& array, int row) const {
  const hsize_t length = h5::shape(data_->file, "/" + array).at(1);
  Eigen::VectorXd values(static_cast<Eigen::Index>(length));
  if (length > 0)
    h5::read_rows(data_->file, "/" + array, {static_cast<hsize_t>(row), {1, length}}, values.data());
  return values;
}

}  // namespace elastogear::io
