// OpenBLAS takes a buffer for each of its threads as it is loaded, before main, and asks for ever where the
// system refuses it. Where memory is limited, this runs before the libraries start, and begins anew with one
// thread.

#include <fcntl.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstddef>
#include <cstring>

namespace {

constexpr rlim_t kForEachThread = rlim_t{1} << 30;  // bytes: some buffers, a stack and what a thread works on
constexpr char kName[] = "OPENBLAS_NUM_THREADS=";
char one_thread[] = "OPENBLAS_NUM_THREADS=1";
constexpr std::size_t kMostVariables = 8192;

#define BEFORE_THE_SANITIZERS __attribute__((no_sanitize("address", "undefined")))

BEFORE_THE_SANITIZERS bool is_short(int resource) {
  rlimit limit{};
  cpu_set_t cores;
  CPU_ZERO(&cores);
  if (getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return false;
  const int n = sched_getaffinity(0, sizeof cores, &cores) == 0 ? CPU_COUNT(&cores) : CPU_SETSIZE;
  return limit.rlim_cur < static_cast<rlim_t>(n) * kForEachThread;
}

// Runs before the C library has started: it calls nothing that needs that.
BEFORE_THE_SANITIZERS void take_one_thread(int, char** argv, char** environment) {
  static char* variables[kMostVariables + 2];
  static char program[4096];
  std::size_t n = 0;
  for (; environment[n]; ++n) {
    if (n == kMostVariables || strncmp(environment[n], kName, sizeof kName - 1) == 0) return;
    variables[n] = environment[n];
  }
  if (!is_short(RLIMIT_AS) && !is_short(RLIMIT_DATA)) return;
  if (syscall(SYS_readlink, "/proc/self/exe", program, sizeof program - 1) <= 0) return;
  variables[n] = one_thread;
  syscall(SYS_execve, program, argv, variables);  // returns where it fails, and all stays as it is
}

__attribute__((section(".preinit_array"), used)) void (*const kFirst)(int, char**, char**) = take_one_thread;

}  // namespace
