// Datasets of numbers. Each has a checksum: that of HDF5's Fletcher-32 filter on every chunk, or, one number
// alone, that of the object's header, in which it stands.

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <numeric>
#include <optional>

#include "elastogear/base/finite.h"
#include "elastogear/base/text.h"
#include "io/hdf5/chunks.h"
#include "io/hdf5/hdf5_objects.h"

namespace elastogear::io::h5 {
namespace {

constexpr hsize_t kChunkBytes = 1 << 20;
constexpr hsize_t kBlock = 128;  // rows and columns of a chunk of a matrix, 128 KiB
// A compressed dataset is at most about 1000 times its bytes in the file: more is a damaged header.
constexpr double kMaxRatio = 2000, kSlack = 1 << 20;
constexpr const char* kNotFinite = "holds a number that is not finite";

// Properties of reading and writing: numbers are converted in memory of ours. Where HDF5 lacks memory for
// that, it clears its lists of free blocks, the one in use among them, and goes on with what it has freed.
hid_t transfer() {
  constexpr std::size_t kSize = 1 << 16;
  alignas(std::max_align_t) static unsigned char converted[kSize], background[kSize];
  static const hid_t properties = [] {
    const hid_t made = H5Pcreate(H5P_DATASET_XFER);
    return made >= 0 && H5Pset_buffer(made, kSize, converted, background) >= 0 ? made : H5P_DEFAULT;
  }();
  return properties;
}

bool is_empty(const Shape& shape) { return std::find(shape.begin(), shape.end(), 0u) != shape.end(); }

// Whole rows, as equal chunks of at most 1 MiB as can be.
Shape chunk_of_rows(const Shape& shape, hsize_t bytes_per_number) {
  const hsize_t row = std::accumulate(shape.begin() + 1, shape.end(), bytes_per_number, std::multiplies<>());
  const hsize_t most = std::max<hsize_t>(1, kChunkBytes / row);
  const hsize_t chunks = (shape[0] + most - 1) / most;
  Shape chunk = shape;
  chunk[0] = (shape[0] + chunks - 1) / chunks;
  return chunk;
}

// chunk: empty for a single number; nothing is stored of an empty shape.
Id creation_properties(const Shape& shape, const Shape& chunk, bool compress) {
  Id properties(H5Pcreate(H5P_DATASET_CREATE));
  keep_attributes_in_header(properties);
  if (chunk.empty()) H5Pset_layout(properties, H5D_COMPACT);
  if (chunk.empty() || is_empty(shape)) return properties;
  H5Pset_chunk(properties, static_cast<int>(chunk.size()), chunk.data());
  if (compress) {
    H5Pset_shuffle(properties);
    H5Pset_deflate(properties, 4);
  }
  H5Pset_fletcher32(properties);
  return properties;
}

Id create_dataset(const File& file, const std::string& name, hid_t type, hid_t space, hid_t properties) {
  Id dataset(H5Dcreate2(file.id, name.c_str(), type, space, link_properties(), properties, H5P_DEFAULT));
  check_written(dataset >= 0, file, name);
  return dataset;
}

Id open_dataset(const File& file, const std::string& name) {
  Id object = open_object(file, name);
  check(H5Iget_type(object) == H5I_DATASET, file, name, "is not a dataset");
  return object;
}

// The rows in the dataset's space, or nothing.
Id select(hid_t dataset, const Rows& rows) {
  Id space(H5Dget_space(dataset));
  Shape start(rows.count.size(), 0);
  start[0] = rows.first;
  const bool good =
      H5Sget_simple_extent_ndims(space) == static_cast<int>(start.size()) &&
      H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, rows.count.data(), nullptr) >= 0;
  return good ? std::move(space) : Id();
}

// Rows of a chunk, which HDF5 reads as a whole; of a dataset without chunks as many as one would have.
hsize_t rows_at_a_time(hid_t dataset, const Shape& shape) {
  const Id properties(H5Dget_create_plist(dataset));
  Shape chunk(shape.size());
  const bool chunked = H5Pget_layout(properties) == H5D_CHUNKED &&
                       H5Pget_chunk(properties, static_cast<int>(chunk.size()), chunk.data()) >= 0;
  return (chunked ? chunk : chunk_of_rows(shape, sizeof(double)))[0];
}

std::string text(const Shape& shape) {
  const auto size = [](hsize_t n) { return n == kAny ? "n" : std::to_string(n); };
  return shape.empty() ? "one number" : join(shape, " x ", size);
}

bool matches(const Shape& shape, const Shape& expected) {
  return std::equal(shape.begin(), shape.end(), expected.begin(), expected.end(),
                    [](hsize_t n, hsize_t m) { return m == kAny || n == m; });
}

void require_read(bool good, const File& file, const std::string& name) {
  if (!good) damaged(file, "checksum of " + name);
}

template <class T>
void require_finite(const T* data, std::size_t n, const File& file, const std::string& name) {
  if constexpr (std::is_floating_point_v<T>)
    check(all_finite(data, static_cast<Eigen::Index>(n)), file, name, kNotFinite);
}

}  // namespace

Id simple_space(const Shape& shape) {
  return Id(shape.empty() ? H5Screate(H5S_SCALAR)
                          : H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr));
}

Shape shape_of(hid_t space) {
  Shape shape(std::max(H5Sget_simple_extent_ndims(space), 0));
  if (!shape.empty()) H5Sget_simple_extent_dims(space, shape.data(), nullptr);
  return shape;
}

std::size_t checked_size(const File& file, const std::string& name, const Shape& shape) {
  double size = 1;
  for (hsize_t n : shape) size *= static_cast<double>(n);
  const double bytes = static_cast<double>(std::filesystem::file_size(file.path));
  check(size * sizeof(double) <= kMaxRatio * bytes + kSlack, file, name, "is larger than the file can hold");
  return static_cast<std::size_t>(size);
}

template <class T>
void write(const File& file, const std::string& name, const View<T>& view, const std::string& unit,
           bool compress) {
  const bool empty = is_empty(view.shape);
  const Shape chunk = empty || view.shape.empty() ? view.shape : chunk_of_rows(view.shape, sizeof(T));
  const Id dataset = create_dataset(file, name, native<T>(), simple_space(view.shape),
                                    creation_properties(view.shape, chunk, compress));
  const bool written = empty || H5Dwrite(dataset, native<T>(), H5S_ALL, H5S_ALL, transfer(), view.data) >= 0;
  check_written(written, file, name);
  set_attribute(file, name, "unit", unit);
}
template void write(const File&, const std::string&, const View<double>&, const std::string&, bool);
template void write(const File&, const std::string&, const View<int>&, const std::string&, bool);

void write_blocks(const File& file, const std::string& name, const View<double>& matrix,
                  const std::string& unit) {
  if (is_empty(matrix.shape)) return write(file, name, matrix, unit);
  const hsize_t rows = matrix.shape[0], columns = matrix.shape[1];
  const Shape chunk{std::min(rows, kBlock), std::min(columns, kBlock)};
  const Id dataset = create_dataset(file, name, native<double>(), simple_space(matrix.shape),
                                    creation_properties(matrix.shape, chunk, true));
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto index = [](hsize_t n) { return static_cast<Eigen::Index>(n); };
  const Eigen::Map<const Matrix> all(matrix.data, index(rows), index(columns));
  for (hsize_t row = 0; row < rows; row += chunk[0])
    for (hsize_t column = 0; column < columns; column += chunk[1]) {
      const Shape start{row, column},
          count{std::min(chunk[0], rows - row), std::min(chunk[1], columns - column)};
      const Matrix block = all.block(index(row), index(column), index(count[0]), index(count[1]));
      if ((block.array() == 0).all()) continue;
      const Id space(H5Dget_space(dataset)), memory = simple_space(count);
      H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
      check_written(H5Dwrite(dataset, native<double>(), memory, space, transfer(), block.data()) >= 0, file,
                    name);
    }
  set_attribute(file, name, "unit", unit);
}

void write_strings(const File& file, const std::string& name, const std::vector<std::string>& strings) {
  std::size_t length = 1;
  for (const std::string& s : strings) length = std::max(length, s.size());
  std::string bytes;
  for (const std::string& s : strings) bytes += s + std::string(length - s.size(), '\0');
  const Id type = text_type(length);
  const Shape shape{strings.size()};
  const Shape chunk = strings.empty() ? shape : chunk_of_rows(shape, length);
  const Id dataset =
      create_dataset(file, name, type, simple_space(shape), creation_properties(shape, chunk, false));
  const bool written =
      strings.empty() || H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) >= 0;
  check_written(written, file, name);
  set_attribute(file, name, "unit", "1");
}

bool holds_text(const File& file, const std::string& name) {
  return H5Tget_class(Id(H5Dget_type(open_dataset(file, name)))) == H5T_STRING;
}

hsize_t rows_together(const File& file, const std::string& name) {
  const Id dataset = open_dataset(file, name);
  const Shape all = shape_of(Id(H5Dget_space(dataset)));
  check(!all.empty(), file, name, "has no rows");
  return rows_at_a_time(dataset, all);
}

Shape shape(const File& file, const std::string& name) {
  return shape_of(Id(H5Dget_space(open_dataset(file, name))));
}

template <class T>
std::vector<T> read(const File& file, const std::string& name, const Shape& expected, Finite finite) {
  const Id dataset = open_dataset(file, name), type(H5Dget_type(dataset)), space(H5Dget_space(dataset));
  const H5T_class_t kind = H5Tget_class(type);
  const bool number = kind == H5T_INTEGER || (std::is_same_v<T, double> && kind == H5T_FLOAT);
  check(number, file, name, "does not hold numbers of the right kind");
  const Shape found = shape_of(space);
  if (!matches(found, expected))
    fail(file.path, ": ", name, " has the shape ", text(found), ", must be ", text(expected));
  std::vector<T> values(checked_size(file, name, found));
  require_read(
      values.empty() || H5Dread(dataset, native<T>(), H5S_ALL, H5S_ALL, transfer(), values.data()) >= 0, file,
      name);
  if (finite == Finite::required) require_finite(values.data(), values.size(), file, name);
  return values;
}
template std::vector<double> read(const File&, const std::string&, const Shape&, Finite);
template std::vector<int> read(const File&, const std::string&, const Shape&, Finite);

std::vector<std::string> read_strings(const File& file, const std::string& name) {
  const Id dataset = open_dataset(file, name), type(H5Dget_type(dataset)), space(H5Dget_space(dataset));
  check(H5Tget_class(type) == H5T_STRING, file, name, "does not hold strings");
  const std::size_t n = checked_size(file, name, shape_of(space));
  if (n == 0) return {};
  bool good = false;
  const auto reader = [&](hid_t memory, void* data) {
    return H5Dread(dataset, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0;
  };
  auto strings = decode(type, space, n, reader, good);
  require_read(good, file, name);
  return strings;
}

Id create_chunked(const File& file, const std::string& name, const Chunked& layout) {
  Id dataset =
      create_dataset(file, name, layout.single ? H5T_NATIVE_FLOAT : H5T_NATIVE_DOUBLE,
                     simple_space(layout.shape), creation_properties(layout.shape, layout.chunk, false));
  set_attribute(file, name, "unit", layout.unit);
  return dataset;
}

Id create_growing(const File& file, const std::string& name, const Item& item, hsize_t rows_per_chunk) {
  Shape start{0}, limit{H5S_UNLIMITED}, chunk{rows_per_chunk};
  for (Shape* s : {&start, &limit, &chunk}) s->insert(s->end(), item.shape.begin(), item.shape.end());
  const Id space(H5Screate_simple(static_cast<int>(start.size()), start.data(), limit.data()));
  const hid_t number = item.single ? H5T_IEEE_F32LE : H5T_IEEE_F64LE;
  Id dataset = create_dataset(file, name, item.integer ? H5T_STD_I64LE : number, space,
                              creation_properties(chunk, chunk, false));
  set_attribute(file, name, "unit", item.unit);
  return dataset;
}

void set_shape(const File& file, hid_t dataset, const Shape& shape) {
  check_written(H5Dset_extent(dataset, shape.data()) >= 0, file, "a dataset");
}

template <class T>
void write_rows(const File& file, hid_t dataset, const Rows& rows, const T* data) {
  if (const std::optional<bool> written = write_chunks(dataset, rows, data))
    return check_written(*written, file, "a dataset");
  const Id space = select(dataset, rows), memory = simple_space(rows.count);
  check_written(space >= 0 && H5Dwrite(dataset, native<T>(), memory, space, transfer(), data) >= 0, file,
                "a dataset");
}
template void write_rows(const File&, hid_t, const Rows&, const double*);
template void write_rows(const File&, hid_t, const Rows&, const float*);

template <class T>
void read_rows(const File& file, const std::string& name, const Rows& rows, T* data) {
  const Id dataset = open_dataset(file, name), space = select(dataset, rows),
           memory = simple_space(rows.count);
  check(space >= 0, file, name, "lacks rows");
  if (const std::optional<bool> finite = read_chunks(dataset, rows, data))
    return check(*finite, file, name, kNotFinite);
  require_read(H5Dread(dataset, native<T>(), memory, space, transfer(), data) >= 0, file, name);
  require_finite(data,
                 std::accumulate(rows.count.begin(), rows.count.end(), std::size_t{1}, std::multiplies<>()),
                 file, name);
}
template void read_rows(const File&, const std::string&, const Rows&, double*);
template void read_rows(const File&, const std::string&, const Rows&, float*);

void visit_rows(const File& file, const std::string& name,
                const std::function<void(hsize_t row, const double* numbers)>& visit) {
  const Id dataset = open_dataset(file, name), type(H5Dget_type(dataset)), space(H5Dget_space(dataset));
  const H5T_class_t kind = H5Tget_class(type);
  check(kind == H5T_INTEGER || kind == H5T_FLOAT, file, name, "does not hold numbers of the right kind");
  const Shape all = shape_of(space);
  check(!all.empty(), file, name, "has no rows");
  if (checked_size(file, name, all) == 0) return;
  const hsize_t n_chunk = rows_at_a_time(dataset, all);
  const std::size_t row_size =
      std::accumulate(all.begin() + 1, all.end(), std::size_t{1}, std::multiplies<>());
  std::vector<double> numbers;
  for (hsize_t first = 0; first < all[0]; first += n_chunk) {
    Rows rows{first, all};
    rows.count[0] = std::min(n_chunk, all[0] - first);
    numbers.resize(rows.count[0] * row_size);
    read_rows(file, name, rows, numbers.data());
    for (hsize_t i = 0; i < rows.count[0]; ++i) visit(first + i, numbers.data() + i * row_size);
  }
}

std::string unit(const File& file, const std::string& name) { return string_attribute(file, name, "unit"); }

}  // namespace elastogear::io::h5
