#pragma once
// Handles and helpers that the files hdf5*.cpp share.

#include <functional>
#include <string>

#include "io/hdf5/hdf5.h"

namespace elastogear::io::h5 {

template <class T>
hid_t native();
template <>
inline hid_t native<double>() {
  return H5T_NATIVE_DOUBLE;
}
template <>
inline hid_t native<float>() {
  return H5T_NATIVE_FLOAT;
}
template <>
inline hid_t native<int>() {
  return H5T_NATIVE_INT;
}

/// Error when there is no such object, or when it is damaged.
Id open_object(const File& file, const std::string& name);

/// For groups and the root: every attribute stands in the object's header, which has a checksum.
void keep_attributes_in_header(hid_t creation_properties);

/// For new objects: the groups above them are made.
Id link_properties();

Id simple_space(const Shape& shape);
Shape shape_of(hid_t space);
/// Number of elements, refused when the file cannot hold them.
std::size_t checked_size(const File& file, const std::string& name, const Shape& shape);

/// Text of a fixed number of bytes, UTF-8: text of variable length would lie in a heap without checksums.
Id text_type(std::size_t bytes);
/// n texts of variable or fixed length; `read` fills a buffer of the memory type it is given. `good`: it did.
std::vector<std::string> decode(hid_t type, hid_t space, std::size_t n,
                                const std::function<bool(hid_t, void*)>& read, bool& good);

}  // namespace elastogear::io::h5
