#include "elastogear/base/memory.h"

#include <cstdlib>
#include <memory>

#ifdef __GLIBC__
#include <malloc.h>
#endif
#ifdef __linux__
#include <sys/mman.h>
#endif

namespace elastogear {

void give_back_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

void use_large_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  constexpr std::size_t kLarge = std::size_t{1} << 21;
  std::size_t room = bytes;
  if (std::align(kLarge, kLarge, memory, room)) madvise(memory, room / kLarge * kLarge, MADV_HUGEPAGE);
#endif
}

}  // namespace elastogear
