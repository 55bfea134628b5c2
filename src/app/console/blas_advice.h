#pragma once
// Checks that the linked BLAS makes use of this processor.

#include <string>

namespace elastogear::app {

/// Setting to put into the environment when OpenBLAS does not know this processor and takes kernels without
/// its AVX-512 instructions (OpenBLAS 0.3.21 on AMD Zen 4 and 5); else empty.
std::string blas_advice();

}  // namespace elastogear::app
