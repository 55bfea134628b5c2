#include "app/console/blas_kernels.h"

#include <dlfcn.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdlib>
#include <set>

#include "elastogear/base/dense_product.h"
#include "elastogear/base/error.h"

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

// 1 with another BLAS.
int blas_threads() {
  const auto get = reinterpret_cast<int (*)()>(dlsym(RTLD_DEFAULT, "openblas_get_num_threads"));
  return get ? get() : 1;
}

void set_blas_threads(int n) {
  const auto set = reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads"));
  if (set && !std::getenv("OPENBLAS_NUM_THREADS")) set(n);
}

// Bytes that the process may have.
rlim_t memory_limit() {
  rlim_t least = RLIM_INFINITY;
  for (const auto resource : {RLIMIT_AS, RLIMIT_DATA})
    if (rlimit limit{}; getrlimit(resource, &limit) == 0) least = std::min(least, limit.rlim_cur);
  return least;
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

void use_one_blas_thread() { set_blas_threads(1); }

OneBlasThread::OneBlasThread() : before_(blas_threads()) { set_blas_threads(1); }
OneBlasThread::~OneBlasThread() { set_blas_threads(before_); }

void take_blas_memory() {
  constexpr std::size_t kBuffer = std::size_t{1} << 27, kWork = std::size_t{1} << 25;  // bytes
  constexpr Eigen::Index kRows = 200;  // smaller products go without the buffer
  if (openblas_core().empty() || memory_limit() == RLIM_INFINITY) return;
  void* room = mmap(nullptr, kBuffer + kWork, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  require(room != MAP_FAILED, "the limit of memory, ", memory_limit() / 1024,
          " kB (ulimit -v or -d), leaves no room for the ", kBuffer / 1024,
          " kB that OpenBLAS needs: raise it");
  munmap(room, kBuffer + kWork);
  const Eigen::MatrixXd A = Eigen::MatrixXd::Identity(kRows, kRows);
  Eigen::MatrixXd C = A;
  multiply(Op::plain, Op::plain, 1.0, A, A, 0.0, C);
}

}  // namespace elastogear::app
