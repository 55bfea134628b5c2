#pragma once
// Memory of the process.

namespace elastogear {

/// Gives free memory of the heap back to the system, where the C library can (glibc).
void give_back_memory();

}  // namespace elastogear
