#pragma once
// Rows of a dataset straight from its chunks and into them: HDF5's own way copies every chunk twice, and its
// checksum takes a number at a time.

#include <optional>

#include "io/hdf5/hdf5.h"

namespace elastogear::io::h5 {

/// Reads rows of numbers that are stored as in memory, in chunks of whole rows with Fletcher-32 and no other
/// filter. Returns whether all are finite; nothing when the dataset is stored in another way or a checksum
/// does not fit: H5Dread then has to read or to refuse it. T: double or float.
template <class T>
std::optional<bool> read_chunks(hid_t dataset, const Rows& rows, T* data);

/// Writes rows that are whole chunks of such a dataset. Returns whether HDF5 has taken them; nothing, and
/// then H5Dwrite has to write them, when the dataset is stored in another way or a chunk has other rows, too.
template <class T>
std::optional<bool> write_chunks(hid_t dataset, const Rows& rows, const T* data);

}  // namespace elastogear::io::h5
