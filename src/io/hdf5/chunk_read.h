#pragma once
// Rows of a dataset straight from its chunks: HDF5's own way copies every chunk twice.

#include <optional>

#include "io/hdf5/hdf5.h"

namespace elastogear::io::h5 {

/// Reads rows of numbers that are stored as in memory, in chunks of whole rows with Fletcher-32 and no other
/// filter. Returns whether all are finite; nothing when the dataset is stored in another way or a checksum
/// does not fit: H5Dread then has to read or to refuse it. T: double or float.
template <class T>
std::optional<bool> read_chunks(hid_t dataset, const Rows& rows, T* data);

}  // namespace elastogear::io::h5
