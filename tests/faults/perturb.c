// A library to preload (LD_PRELOAD) into programs under test: it fills memory that is given out or given
// back, so that what reads it before it is written, or after it is gone, finds no numbers there.
// MALLOC_PERTURB_ of the C library does the same, but fills the 32 MB that MUMPS takes and gives back with
// every solution, too, which is half the time of some tests.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <malloc.h>
#include <stdint.h>
#include <string.h>

enum { GIVEN_OUT = 0x5a, GIVEN_BACK = 0xa5, LARGE = 1 << 20 };

void* __libc_malloc(size_t size);
void* __libc_realloc(void* block, size_t size);
void* __libc_memalign(size_t alignment, size_t size);
void __libc_free(void* block);

// Large blocks of MUMPS are its own workspace.
static int is_filled(size_t size, const void* caller) {
  Dl_info of;
  return size < LARGE || !dladdr(caller, &of) || !strstr(of.dli_fname, "mumps");
}

static void* filled(void* block, size_t size, const void* caller) {
  if (block && is_filled(size, caller)) memset(block, GIVEN_OUT, size);
  return block;
}

void* malloc(size_t size) { return filled(__libc_malloc(size), size, __builtin_return_address(0)); }

void* memalign(size_t alignment, size_t size) {
  return filled(__libc_memalign(alignment, size), size, __builtin_return_address(0));
}

void* aligned_alloc(size_t alignment, size_t size) {
  return filled(__libc_memalign(alignment, size), size, __builtin_return_address(0));
}

int posix_memalign(void** block, size_t alignment, size_t size) {
  void* made = __libc_memalign(alignment, size);
  if (!made) return ENOMEM;
  *block = filled(made, size, __builtin_return_address(0));
  return 0;
}

void* realloc(void* block, size_t size) {
  const size_t before = block ? malloc_usable_size(block) : 0;
  char* grown = __libc_realloc(block, size);
  if (grown && size > before) filled(grown + before, size - before, __builtin_return_address(0));
  return grown;
}

void free(void* block) {
  if (!block) return;
  const size_t size = malloc_usable_size(block);
  const int error = errno;
  if (is_filled(size, __builtin_return_address(0))) memset(block, GIVEN_BACK, size);
  errno = error;
  __libc_free(block);
}
