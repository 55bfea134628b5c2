#include "io/hdf5/chunks.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <functional>
#include <numeric>

#include "elastogear/base/finite.h"
#include "io/hdf5/fletcher32.h"
#include "io/hdf5/hdf5_objects.h"

namespace elastogear::io::h5 {
namespace {

constexpr std::size_t kChecksumBytes = 4;

hsize_t product(const Shape& shape, std::size_t first) {
  return std::accumulate(shape.begin() + static_cast<std::ptrdiff_t>(first), shape.end(), hsize_t{1},
                         std::multiplies<>());
}

// Is Fletcher-32 the only filter?
bool has_checksum_alone(hid_t properties) {
  if (H5Pget_nfilters(properties) != 1) return false;
  unsigned flags = 0, config = 0;
  std::size_t n_values = 0;
  return H5Pget_filter2(properties, 0, &flags, &n_values, nullptr, 0, nullptr, &config) ==
         H5Z_FILTER_FLETCHER32;
}

// Rows in a chunk; 0 when the dataset is stored in another way or does not have the rows.
template <class T>
hsize_t rows_of_chunk(hid_t dataset, const Rows& rows) {
  const Id properties(H5Dget_create_plist(dataset)), type(H5Dget_type(dataset)), space(H5Dget_space(dataset));
  const Shape shape = shape_of(space);
  if (std::endian::native != std::endian::little || H5Tequal(type, native<T>()) <= 0) return 0;
  if (shape.empty() || H5Pget_layout(properties) != H5D_CHUNKED || !has_checksum_alone(properties)) return 0;
  Shape chunk(shape.size()), wanted = rows.count;
  if (H5Pget_chunk(properties, static_cast<int>(chunk.size()), chunk.data()) < 0) return 0;
  const hsize_t n = chunk[0];
  if (wanted.size() != shape.size() || rows.first > shape[0] || wanted[0] > shape[0] - rows.first) return 0;
  chunk[0] = wanted[0] = shape[0];
  return chunk == shape && wanted == shape ? n : 0;
}

// Does the chunk at an offset hold so many bytes of numbers and their checksum?
bool is_stored(hid_t dataset, const Shape& offset, std::size_t bytes) {
  hsize_t stored = 0;
  return H5Dget_chunk_storage_size(dataset, offset.data(), &stored) >= 0 && stored == bytes + kChecksumBytes;
}

bool read_chunk(hid_t dataset, const Shape& offset, std::size_t bytes, char* to) {
  std::uint32_t left_out = 0, checksum = 0;
  if (H5Dread_chunk(dataset, H5P_DEFAULT, offset.data(), &left_out, to) < 0 || left_out != 0) return false;
  std::memcpy(&checksum, to + bytes, kChecksumBytes);
  return checksum == fletcher32(to, bytes);
}

}  // namespace

// A chunk goes to its place if its checksum has room there, for it is followed by rows that are read after
// it.
template <class T>
std::optional<bool> read_chunks(hid_t dataset, const Rows& rows, T* data) {
  const hsize_t n_chunk = rows_of_chunk<T>(dataset, rows);
  if (n_chunk == 0) return std::nullopt;
  const hsize_t row = product(rows.count, 1), end = rows.first + rows.count[0];
  const std::size_t bytes = n_chunk * row * sizeof(T);
  std::vector<char> scratch;
  Shape offset = rows.count;
  std::fill(offset.begin(), offset.end(), 0);
  bool finite = true;
  for (hsize_t first = rows.first / n_chunk * n_chunk; first < end; first += n_chunk) {
    const hsize_t from = std::max(first, rows.first), to = std::min(first + n_chunk, end);
    T* const place = data + (from - rows.first) * row;
    const bool has_room = first == from && first + n_chunk < end && row * sizeof(T) >= kChecksumBytes;
    offset[0] = first;
    if (!is_stored(dataset, offset, bytes)) return std::nullopt;
    if (!has_room) scratch.resize(bytes + kChecksumBytes);
    char* const chunk = has_room ? reinterpret_cast<char*>(place) : scratch.data();
    if (!read_chunk(dataset, offset, bytes, chunk)) return std::nullopt;
    if (!has_room)
      std::memcpy(place, chunk + (from - first) * row * sizeof(T), (to - from) * row * sizeof(T));
    finite = finite && all_finite(place, static_cast<Eigen::Index>((to - from) * row));
  }
  return finite;
}
template std::optional<bool> read_chunks(hid_t, const Rows&, double*);
template std::optional<bool> read_chunks(hid_t, const Rows&, float*);

template <class T>
std::optional<bool> write_chunks(hid_t dataset, const Rows& rows, const T* data) {
  const hsize_t n_chunk = rows_of_chunk<T>(dataset, rows);
  if (n_chunk == 0 || rows.first % n_chunk != 0 || rows.count[0] % n_chunk != 0) return std::nullopt;
  const std::size_t bytes = n_chunk * product(rows.count, 1) * sizeof(T);
  std::vector<char> chunk(bytes + kChecksumBytes);
  Shape offset(rows.count.size(), 0);
  const auto* from = reinterpret_cast<const char*>(data);
  for (hsize_t row = 0; row < rows.count[0]; row += n_chunk, from += bytes) {
    offset[0] = rows.first + row;
    std::memcpy(chunk.data(), from, bytes);
    const std::uint32_t checksum = fletcher32(chunk.data(), bytes);
    std::memcpy(chunk.data() + bytes, &checksum, kChecksumBytes);
    if (H5Dwrite_chunk(dataset, H5P_DEFAULT, 0, offset.data(), chunk.size(), chunk.data()) < 0) return false;
  }
  return true;
}
template std::optional<bool> write_chunks(hid_t, const Rows&, const double*);
template std::optional<bool> write_chunks(hid_t, const Rows&, const float*);

}  // namespace elastogear::io::h5
