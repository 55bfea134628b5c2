#include "app/console/blas_advice.h"

#include <dlfcn.h>

#include "elastogear/base/instructions.h"

namespace elastogear::app {
namespace {

// The processor that OpenBLAS takes this one for; empty with another BLAS.
std::string openblas_core() {
  using Name = const char* (*)();
  const auto name = reinterpret_cast<Name>(dlsym(RTLD_DEFAULT, "openblas_get_corename"));
  return name ? name() : "";
}

}  // namespace

std::string blas_advice() {
  const std::string core = openblas_core();
  const bool without_avx512 = core == "Haswell" || core == "Zen";
  if (!without_avx512 || best_instructions() != Instructions::avx512) return "";
  return "OpenBLAS takes this processor for a " + core +
         "; OPENBLAS_CORETYPE=SKYLAKEX in the environment is faster";
}

}  // namespace elastogear::app
