#pragma once
// Kernels of the linked BLAS that make use of this processor. OpenBLAS chooses them by the number of the
// processor's model as it is loaded, and takes models that it does not know for old ones: version 0.3.21
// takes Intel's Sapphire and Emerald Rapids for a Prescott, AMD's Zen 4 and 5 for a Haswell.

#include <string>

#include "elastogear/base/instructions.h"

namespace elastogear::app {

/// The value of OPENBLAS_CORETYPE whose kernels use the given instructions, where those of `core`, a name by
/// openblas_get_corename, do not; else, and for cores of unknown names, empty.
std::string faster_core(const std::string& core, Instructions instructions);

/// The variable of the environment by which OpenBLAS is told its kernels.
constexpr const char* kBlasVariable = "OPENBLAS_CORETYPE";

/// Its value that uses this processor, where OpenBLAS as it was loaded does not; else empty.
std::string blas_setting();

/// That setting as a sentence.
std::string blas_advice();

/// Gives OpenBLAS one thread, unless OPENBLAS_NUM_THREADS is set: for processes that share a machine.
void use_one_blas_thread();

/// While it lives, OpenBLAS has one thread: others are too many for time steps and static equilibria, wait
/// for work and yield their processor each time. Those that OPENBLAS_NUM_THREADS asks for remain.
class OneBlasThread {
 public:
  OneBlasThread();
  ~OneBlasThread();
  OneBlasThread(const OneBlasThread&) = delete;
  OneBlasThread& operator=(const OneBlasThread&) = delete;

 private:
  int before_;
};

/// Lets OpenBLAS take its buffer of memory while that is there: it asks for ever where the system refuses.
/// Error when memory is limited (ulimit -v, -d) and there is no room for it.
void take_blas_memory();

}  // namespace elastogear::app
