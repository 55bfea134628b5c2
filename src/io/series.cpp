#include <algorithm>
#include <functional>
#include <numeric>

#include "hdf5.h"

namespace elastogear::io::h5 {
namespace {

constexpr hsize_t kRowsPerBlock = 64;
constexpr hsize_t kBytesPerBlock = 1 << 20;

}  // namespace

Series::Series(const File& file, std::string name, Item item)
    : file_(&file), name_(std::move(name)), item_(std::move(item)) {
  item_size_ = std::accumulate(item_.shape.begin(), item_.shape.end(), hsize_t{1}, std::multiplies<>());
  if (item_size_ == 0) return;  // nothing to store but the number of rows, see flush()
  block_ = std::clamp(kBytesPerBlock / (item_size_ * sizeof(double)), hsize_t{1}, kRowsPerBlock);
  Shape start{0}, limit{H5S_UNLIMITED}, chunk{block_};
  for (Shape* s : {&start, &limit, &chunk}) s->insert(s->end(), item_.shape.begin(), item_.shape.end());
  const Id space(H5Screate_simple(static_cast<int>(start.size()), start.data(), limit.data()));
  const Id properties(H5Pcreate(H5P_DATASET_CREATE)), links(H5Pcreate(H5P_LINK_CREATE));
  H5Pset_chunk(properties, static_cast<int>(chunk.size()), chunk.data());
  H5Pset_create_intermediate_group(links, 1);
  const hid_t number = item_.single ? H5T_IEEE_F32LE : H5T_IEEE_F64LE;
  const hid_t type = item_.integer ? H5T_STD_I64LE : number;
  dataset_ = Id(H5Dcreate2(file.id, name_.c_str(), type, space, links, properties, H5P_DEFAULT));
  check(dataset_ >= 0, file, name_, "cannot be created");
  set_attribute(file, name_, "unit", item_.unit);
}

void Series::append(const double* data, hsize_t rows) {
  if (item_size_ == 0) {
    rows_ += rows;
    return;
  }
  buffer_.insert(buffer_.end(), data, data + rows * item_size_);
  if (buffer_.size() >= block_ * item_size_) flush();
}

void Series::flush() {
  if (item_size_ == 0) {
    Shape empty{rows_};
    empty.insert(empty.end(), item_.shape.begin(), item_.shape.end());
    if (!exists(*file_, name_)) write<double>(*file_, name_, {empty, nullptr}, item_.unit);
    return;
  }
  const hsize_t rows = buffer_.size() / item_size_;
  if (rows == 0) return;
  Shape count{rows}, total{rows_ + rows};
  for (Shape* s : {&count, &total}) s->insert(s->end(), item_.shape.begin(), item_.shape.end());
  check(H5Dset_extent(dataset_, total.data()) >= 0, *file_, name_, "cannot be extended");
  write_rows(*file_, dataset_, {rows_, count}, buffer_.data());
  rows_ += rows;
  buffer_.clear();
}

}  // namespace elastogear::io::h5
