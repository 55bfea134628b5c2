#pragma once
// The checksum of HDF5's filter Fletcher-32, at the speed of memory.

#include <cstddef>
#include <cstdint>

namespace elastogear::io::h5 {

/// Checksum of n bytes, an even number, as HDF5 stores it after those of a chunk: both sums of J. Fletcher
/// (IEEE Trans. Commun. 30 (1982) 247-252) of the 16-bit words, whose first byte is the higher one, modulo
/// 65535, that of the sums above.
std::uint32_t fletcher32(const void* bytes, std::size_t n);

}  // namespace elastogear::io::h5
