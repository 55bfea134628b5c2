#include <algorithm>
#include <functional>
#include <numeric>

#include "io/hdf5/hdf5.h"

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
  dataset_ = create_growing(file, name_, item_, block_);
}

void Series::append(const double* data, hsize_t rows) {
  if (item_size_ == 0) {
    rows_ += rows;
    return;
  }
  buffer_.insert(buffer_.end(), data, data + rows * item_size_);
  // Whole chunks: a part of one would have to be read again for its checksum.
  const hsize_t whole = buffer_.size() / item_size_ / block_ * block_;
  if (whole > 0) write_first(whole);
}

// Writes the first of the buffered rows to the file and takes them out of the buffer.
void Series::write_first(hsize_t rows) {
  Shape count{rows}, total{rows_ + rows};
  for (Shape* s : {&count, &total}) s->insert(s->end(), item_.shape.begin(), item_.shape.end());
  check_written(H5Dset_extent(dataset_, total.data()) >= 0, *file_, name_);
  write_rows(*file_, dataset_, {rows_, count}, buffer_.data());
  rows_ += rows;
  buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(rows * item_size_));
}

void Series::flush() {
  if (item_size_ == 0) {
    Shape empty{rows_};
    empty.insert(empty.end(), item_.shape.begin(), item_.shape.end());
    if (!exists(*file_, name_)) write<double>(*file_, name_, {empty, nullptr}, item_.unit);
    return;
  }
  const hsize_t rows = buffer_.size() / item_size_;
  if (rows > 0) write_first(rows);
}

}  // namespace elastogear::io::h5
