#include "app/console/blas_kernels.h"

#include <dlfcn.h>

#include <cstdlib>
#include <set>

namespace elastogear::app {
namespace {

// The processor that OpenBLAS takes this one for; empty with another BLAS.
std::string openblas_core() {
  using Name = const char* (*)();
  const auto name = reinterpret_cast<Name>(dlsym(RTLD_DEFAULT, "openblas_get_corename"));
  return name ? name() : "";
}

// The best instructions of the kernels for a Skylake with AVX-512, for a Haswell, or of neither.
Instructions kernel_instructions() {
#ifdef __x86_64__
  if (best_instructions() == Instructions::avx512 && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    return Instructions::avx512;
  if (best_instructions() != Instructions::portable) return Instructions::avx2;
#endif
  return Instructions::portable;
}

}  // namespace

std::string faster_core(const std::string& core, Instructions instructions) {
  static const std::set<std::string> with_avx2{"Haswell", "Zen", "Excavator"},
      older{"Prescott",     "Core2",  "Penryn",    "Dunnington", "Nehalem",
            "Sandybridge",  "Atom",   "Nano",      "Opteron",    "Barcelona",
            "Opteron_SSE3", "Bobcat", "Bulldozer", "Piledriver", "Steamroller"};
  if (instructions == Instructions::avx512 && (older.contains(core) || with_avx2.contains(core)))
    return "SKYLAKEX";
  return instructions != Instructions::portable && older.contains(core) ? "HASWELL" : "";
}

std::string blas_setting() { return faster_core(openblas_core(), kernel_instructions()); }

std::string blas_advice() {
  const std::string core = blas_setting();
  if (core.empty()) return "";
  return "OpenBLAS takes this processor for a " + openblas_core() + "; " + kBlasVariable + "=" + core +
         " in the environment is faster";
}

void use_one_blas_thread() {
  using Set = void (*)(int);
  const auto set = reinterpret_cast<Set>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads"));
  if (set && !std::getenv("OPENBLAS_NUM_THREADS")) set(1);
}

}  // namespace elastogear::app
