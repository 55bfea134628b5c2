#include "hdf5.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <functional>
#include <limits>
#include <numeric>

namespace elastogear::io::h5 {
namespace {

// A compressed dataset is at most about 1000 times its bytes in the file: more is a damaged header.
constexpr double kMaxRatio = 2000, kSlack = 1 << 20;

void silence() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

template <class T>
hid_t native();
template <>
hid_t native<double>() {
  return H5T_NATIVE_DOUBLE;
}
template <>
hid_t native<int>() {
  return H5T_NATIVE_INT;
}

Id string_type() {
  Id type(H5Tcopy(H5T_C_S1));
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

// HDF5's own check fails on a path whose parents are missing.
bool link_exists(const File& file, const std::string& name) {
  for (std::size_t slash = name.find('/', 1);; slash = name.find('/', slash + 1)) {
    const std::string part = name.substr(0, slash);
    if (part != "/" && H5Lexists(file.id, part.c_str(), H5P_DEFAULT) <= 0) return false;
    if (slash == std::string::npos) return true;
  }
}

Id open_object(const File& file, const std::string& name) {
  if (!exists(file, name)) fail(file.path, ": there is no ", name);
  Id object(H5Oopen(file.id, name.c_str(), H5P_DEFAULT));
  check(object >= 0, file, name, "cannot be opened");
  return object;
}

Id open_dataset(const File& file, const std::string& name) {
  Id object = open_object(file, name);
  check(H5Iget_type(object) == H5I_DATASET, file, name, "is not a dataset");
  return object;
}

Id creation_properties(const Storage& storage) {
  Id properties(H5Pcreate(H5P_DATASET_CREATE));
  if (!storage.chunk.empty())
    H5Pset_chunk(properties, static_cast<int>(storage.chunk.size()), storage.chunk.data());
  if (storage.compress) {
    H5Pset_shuffle(properties);
    H5Pset_deflate(properties, 4);
  }
  return properties;
}

Id link_properties() {
  Id properties(H5Pcreate(H5P_LINK_CREATE));
  H5Pset_create_intermediate_group(properties, 1);
  return properties;
}

Id create_dataset(const File& file, const std::string& name, hid_t type, hid_t space, hid_t properties) {
  Id dataset(H5Dcreate2(file.id, name.c_str(), type, space, link_properties(), properties, H5P_DEFAULT));
  check(dataset >= 0, file, name, "cannot be created");
  return dataset;
}

Id simple_space(const Shape& shape) {
  return Id(shape.empty() ? H5Screate(H5S_SCALAR)
                          : H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr));
}

Shape shape_of(hid_t space) {
  Shape shape(std::max(H5Sget_simple_extent_ndims(space), 0));
  if (!shape.empty()) H5Sget_simple_extent_dims(space, shape.data(), nullptr);
  return shape;
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

std::string text(const Shape& shape) {
  std::string result;
  for (hsize_t n : shape) result += (result.empty() ? "" : " x ") + (n == kAny ? "n" : std::to_string(n));
  return shape.empty() ? "one number" : result;
}

// Number of elements, refused when the file cannot hold them.
std::size_t checked_size(const File& file, const std::string& name, const Shape& shape) {
  double size = 1;
  for (hsize_t n : shape) size *= static_cast<double>(n);
  const double bytes = static_cast<double>(std::filesystem::file_size(file.path));
  check(size * sizeof(double) <= kMaxRatio * bytes + kSlack, file, name, "is larger than the file can hold");
  return static_cast<std::size_t>(size);
}

bool matches(const Shape& shape, const Shape& expected) {
  return std::equal(shape.begin(), shape.end(), expected.begin(), expected.end(),
                    [](hsize_t n, hsize_t m) { return m == kAny || n == m; });
}

// Strings of variable or fixed length; `read` fills a buffer of the memory type it is given.
std::vector<std::string> decode(hid_t type, hid_t space, std::size_t n,
                                const std::function<bool(hid_t, void*)>& read, bool& good) {
  std::vector<std::string> result;
  if (H5Tis_variable_str(type) > 0) {
    std::vector<char*> pointers(n, nullptr);
    good = read(type, pointers.data());
    if (!good) return {};
    for (const char* pointer : pointers) result.emplace_back(pointer ? pointer : "");
    H5Dvlen_reclaim(type, space, H5P_DEFAULT, pointers.data());
    return result;
  }
  const std::size_t length = H5Tget_size(type);
  std::string buffer(n * length, '\0');
  good = read(type, buffer.data());
  for (std::size_t i = 0; good && i < n; ++i)
    result.emplace_back(buffer.data() + i * length, strnlen(buffer.data() + i * length, length));
  return result;
}

struct Attribute {
  Id id, type, space;
};

Attribute open_attribute(const File& file, const std::string& name, const std::string& key) {
  const Id object = open_object(file, name);
  check(H5Aexists(object, key.c_str()) > 0, file, name, ("has no attribute " + key).c_str());
  Attribute attribute;
  attribute.id = Id(H5Aopen(object, key.c_str(), H5P_DEFAULT));
  check(attribute.id >= 0, file, name, ("attribute " + key + " cannot be opened").c_str());
  attribute.type = Id(H5Aget_type(attribute.id));
  attribute.space = Id(H5Aget_space(attribute.id));
  return attribute;
}

void write_attribute(const File& file, const std::string& name, const std::string& key, hid_t type,
                     std::pair<const Shape&, const void*> value) {
  const Id object = open_object(file, name);
  const Id attribute(
      H5Acreate2(object, key.c_str(), type, simple_space(value.first), H5P_DEFAULT, H5P_DEFAULT));
  check(attribute >= 0 && H5Awrite(attribute, type, value.second) >= 0, file, name,
        ("attribute " + key + " cannot be written").c_str());
}

template <class T>
std::vector<T> numeric_attribute(const File& file, const std::string& name, const std::string& key) {
  const Attribute attribute = open_attribute(file, name, key);
  std::vector<T> values(checked_size(file, name, shape_of(attribute.space)));
  check(!values.empty() && H5Aread(attribute.id, native<T>(), values.data()) >= 0, file, name,
        ("attribute " + key + " is not a number").c_str());
  return values;
}

herr_t collect(hid_t, const char* name, const H5L_info_t*, void* names) {
  static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}

herr_t collect_attribute(hid_t, const char* name, const H5A_info_t*, void* names) {
  static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}

}  // namespace

File create(const std::string& path, const std::string& temporary) {
  silence();
  File file{path, Id(H5Fcreate(temporary.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT))};
  require(file.id >= 0, path, ": cannot be created");
  return file;
}

File open(const std::string& path) {
  silence();
  std::error_code error;
  require(std::filesystem::exists(path, error), path, ": there is no such file");
  require(std::filesystem::is_regular_file(path, error), path, ": is not a regular file");
  require(H5Fis_hdf5(path.c_str()) > 0, path, ": is no HDF5 file, or is truncated");
  File file{path, Id(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT))};
  require(file.id >= 0, path, ": cannot be opened: the HDF5 file is truncated or damaged");
  return file;
}

void close(File& file) {
  const bool written = H5Fflush(file.id, H5F_SCOPE_LOCAL) >= 0;
  file.id = Id();
  require(written, file.path, ": cannot be written");
}

void check(bool good, const File& file, const std::string& object, const char* what) {
  if (!good) fail(file.path, ": ", object, ": ", what);
}

bool exists(const File& file, const std::string& name) { return name == "/" || link_exists(file, name); }

void make_group(const File& file, const std::string& name) {
  const Id group(H5Gcreate2(file.id, name.c_str(), link_properties(), H5P_DEFAULT, H5P_DEFAULT));
  check(group >= 0, file, name, "cannot be created");
}

std::vector<std::string> members(const File& file, const std::string& group) {
  const Id object = open_object(file, group);
  std::vector<std::string> names;
  check(H5Literate(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, collect, &names) >= 0, file, group,
        "is not a group");
  return names;
}

template <class T>
void write(const File& file, const std::string& name, const View<T>& view, const std::string& unit,
           const Storage& storage) {
  // Chunks must not be empty.
  const bool empty = std::find(view.shape.begin(), view.shape.end(), 0u) != view.shape.end();
  const Id dataset = create_dataset(file, name, native<T>(), simple_space(view.shape),
                                    creation_properties(empty ? Storage{} : storage));
  const bool written = empty || H5Dwrite(dataset, native<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, view.data) >= 0;
  check(written, file, name, "cannot be written");
  set_attribute(file, name, "unit", unit);
}
template void write(const File&, const std::string&, const View<double>&, const std::string&, const Storage&);
template void write(const File&, const std::string&, const View<int>&, const std::string&, const Storage&);

void write_strings(const File& file, const std::string& name, const std::vector<std::string>& strings) {
  std::vector<const char*> pointers;
  for (const std::string& s : strings) pointers.push_back(s.c_str());
  const Id type = string_type();
  const Id dataset = create_dataset(file, name, type, simple_space({strings.size()}), H5P_DEFAULT);
  const bool written =
      strings.empty() || H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, pointers.data()) >= 0;
  check(written, file, name, "cannot be written");
  set_attribute(file, name, "unit", "1");
}

Shape shape(const File& file, const std::string& name) {
  return shape_of(Id(H5Dget_space(open_dataset(file, name))));
}

template <class T>
std::vector<T> read(const File& file, const std::string& name, const Shape& expected) {
  const Id dataset = open_dataset(file, name), type(H5Dget_type(dataset)), space(H5Dget_space(dataset));
  const H5T_class_t kind = H5Tget_class(type);
  const bool number = kind == H5T_INTEGER || (std::is_same_v<T, double> && kind == H5T_FLOAT);
  check(number, file, name, "does not hold numbers of the right kind");
  const Shape found = shape_of(space);
  if (!matches(found, expected))
    fail(file.path, ": ", name, " has the shape ", text(found), ", must be ", text(expected));
  std::vector<T> values(checked_size(file, name, found));
  const bool good =
      values.empty() || H5Dread(dataset, native<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0;
  check(good, file, name, "cannot be read: the file is damaged");
  return values;
}
template std::vector<double> read(const File&, const std::string&, const Shape&);
template std::vector<int> read(const File&, const std::string&, const Shape&);

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
  check(good, file, name, "cannot be read: the file is damaged");
  return strings;
}

Id create_chunked(const File& file, const std::string& name, const Chunked& layout) {
  Id dataset = create_dataset(file, name, layout.single ? H5T_NATIVE_FLOAT : H5T_NATIVE_DOUBLE,
                              simple_space(layout.shape), creation_properties({layout.chunk}));
  set_attribute(file, name, "unit", layout.unit);
  return dataset;
}

void write_rows(const File& file, hid_t dataset, const Rows& rows, const double* data) {
  const Id space = select(dataset, rows), memory = simple_space(rows.count);
  check(space >= 0 && H5Dwrite(dataset, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, data) >= 0, file,
        "a dataset", "cannot be written");
}

void read_rows(const File& file, const std::string& name, const Rows& rows, double* data) {
  const Id dataset = open_dataset(file, name), space = select(dataset, rows),
           memory = simple_space(rows.count);
  check(space >= 0 && H5Dread(dataset, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, data) >= 0, file, name,
        "cannot be read: the file is damaged");
}

std::string unit(const File& file, const std::string& name) { return string_attribute(file, name, "unit"); }

void set_attribute(const File& file, const std::string& name, const std::string& key,
                   const std::string& value) {
  const char* pointer = value.c_str();
  write_attribute(file, name, key, string_type(), {{}, &pointer});
}

void set_attribute(const File& file, const std::string& name, const std::string& key, double value) {
  write_attribute(file, name, key, H5T_NATIVE_DOUBLE, {{}, &value});
}

void set_attribute(const File& file, const std::string& name, const std::string& key, int value) {
  write_attribute(file, name, key, H5T_NATIVE_INT, {{}, &value});
}

void set_attribute(const File& file, const std::string& name, const std::string& key,
                   const std::vector<int>& value) {
  write_attribute(file, name, key, H5T_NATIVE_INT, {{value.size()}, value.data()});
}

std::string string_attribute(const File& file, const std::string& name, const std::string& key) {
  const Attribute attribute = open_attribute(file, name, key);
  check(H5Tget_class(attribute.type) == H5T_STRING, file, name, ("attribute " + key + " is no text").c_str());
  check(H5Sget_simple_extent_npoints(attribute.space) == 1, file, name,
        ("attribute " + key + " is not one text").c_str());
  bool good = false;
  const auto reader = [&](hid_t memory, void* data) { return H5Aread(attribute.id, memory, data) >= 0; };
  const auto strings = decode(attribute.type, attribute.space, 1, reader, good);
  check(good, file, name, ("attribute " + key + " is damaged").c_str());
  return strings.front();
}

double number_attribute(const File& file, const std::string& name, const std::string& key) {
  return numeric_attribute<double>(file, name, key).front();
}

std::vector<int> int_attribute(const File& file, const std::string& name, const std::string& key) {
  return numeric_attribute<int>(file, name, key);
}

void write_map(const File& file, const std::string& group, const std::map<std::string, std::string>& map) {
  make_group(file, group);
  for (const auto& [key, value] : map) set_attribute(file, group, key, value);
}

std::map<std::string, std::string> read_map(const File& file, const std::string& group) {
  const Id object = open_object(file, group);
  std::vector<std::string> keys;
  check(H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, collect_attribute, &keys) >= 0, file, group,
        "cannot be read");
  std::map<std::string, std::string> map;
  for (const std::string& key : keys) map[key] = string_attribute(file, group, key);
  return map;
}

}  // namespace elastogear::io::h5
