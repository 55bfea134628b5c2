// Attributes. All stand in the header of their object, which HDF5 protects by a checksum.

#include <algorithm>
#include <cstring>

#include "io/hdf5/hdf5_objects.h"

namespace elastogear::io::h5 {
namespace {

// An attribute holds less than 64 KiB: longer text goes on in key+2, key+3, ...
constexpr std::size_t kMostText = 60000;

struct Attribute {
  Id id, type, space;
};

std::string continued(const std::string& key, int i) { return i == 1 ? key : key + "+" + std::to_string(i); }

// "key+2" where there is "key" as well.
bool continues(const std::string& key, const std::vector<std::string>& keys) {
  const std::size_t plus = key.rfind('+');
  return plus != std::string::npos &&
         std::find(keys.begin(), keys.end(), key.substr(0, plus)) != keys.end() &&
         key.find_first_not_of("0123456789", plus + 1) == std::string::npos;
}

Attribute open_attribute(const File& file, const std::string& name, const std::string& key) {
  check(has_attribute(file, name, key), file, name, ("has no attribute " + key).c_str());
  const Id object = open_object(file, name);
  Attribute attribute;
  attribute.id = Id(H5Aopen(object, key.c_str(), H5P_DEFAULT));
  if (attribute.id < 0) damaged(file, "attribute " + key + " of " + name);
  attribute.type = Id(H5Aget_type(attribute.id));
  attribute.space = Id(H5Aget_space(attribute.id));
  return attribute;
}

void write_attribute(const File& file, const std::string& name, const std::string& key, hid_t type,
                     std::pair<const Shape&, const void*> value) {
  const Id object = open_object(file, name);
  const Id attribute(
      H5Acreate2(object, key.c_str(), type, simple_space(value.first), H5P_DEFAULT, H5P_DEFAULT));
  check_written(attribute >= 0 && H5Awrite(attribute, type, value.second) >= 0, file,
                name + ", attribute " + key);
}

template <class T>
std::vector<T> numeric_attribute(const File& file, const std::string& name, const std::string& key) {
  const Attribute attribute = open_attribute(file, name, key);
  std::vector<T> values(checked_size(file, name, shape_of(attribute.space)));
  check(!values.empty() && H5Aread(attribute.id, native<T>(), values.data()) >= 0, file, name,
        ("attribute " + key + " is not a number").c_str());
  return values;
}

std::string text_of(const File& file, const std::string& name, const std::string& key) {
  const Attribute attribute = open_attribute(file, name, key);
  check(H5Tget_class(attribute.type) == H5T_STRING, file, name, ("attribute " + key + " is no text").c_str());
  check(H5Sget_simple_extent_npoints(attribute.space) == 1, file, name,
        ("attribute " + key + " is not one text").c_str());
  bool good = false;
  const auto reader = [&](hid_t memory, void* data) { return H5Aread(attribute.id, memory, data) >= 0; };
  const auto strings = decode(attribute.type, attribute.space, 1, reader, good);
  if (!good) damaged(file, "attribute " + key + " of " + name);
  return strings.front();
}

herr_t collect(hid_t, const char* name, const H5A_info_t*, void* names) {
  static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}

}  // namespace

Id text_type(std::size_t bytes) {
  Id type(H5Tcopy(H5T_C_S1));
  H5Tset_size(type, std::max<std::size_t>(bytes, 1));
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

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

bool has_attribute(const File& file, const std::string& name, const std::string& key) {
  const htri_t found = H5Aexists(open_object(file, name), key.c_str());
  if (found < 0) damaged(file, "attributes of " + name);
  return found > 0;
}

void set_attribute(const File& file, const std::string& name, const std::string& key,
                   const std::string& value) {
  for (std::size_t first = 0, i = 1; i == 1 || first < value.size(); first += kMostText, ++i) {
    const std::string piece = value.substr(first, kMostText);
    write_attribute(file, name, continued(key, static_cast<int>(i)), text_type(piece.size()),
                    {{}, piece.c_str()});
  }
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
  std::string text = text_of(file, name, key);
  for (int i = 2; text.size() == (i - 1) * kMostText && has_attribute(file, name, continued(key, i)); ++i)
    text += text_of(file, name, continued(key, i));
  return text;
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
  if (H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, collect, &keys) < 0)
    damaged(file, "attributes of " + group);
  std::map<std::string, std::string> map;
  for (const std::string& key : keys)
    if (!continues(key, keys)) map[key] = string_attribute(file, group, key);
  return map;
}

}  // namespace elastogear::io::h5
