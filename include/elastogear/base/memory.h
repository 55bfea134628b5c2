#pragma once
// Memory of the process.

#include <cstddef>

namespace elastogear {

/// Gives free memory of the heap back to the system, where the C library can (glibc).
void give_back_memory();

/// Lets the system lay the memory, which nothing has been written to, out in large pages (Linux, where that
/// is left to programs): millions of numbers are then entered, and read from all over, without faults and
/// misses of small pages.
void use_large_pages(void* memory, std::size_t bytes);

}  // namespace elastogear
