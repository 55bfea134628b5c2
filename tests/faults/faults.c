// A library to preload (LD_PRELOAD) into a program under test: it ends the program, or fails as a full disk
// does, at a chosen call on a chosen file, so that a test does not depend on how fast the machine is.
//
//   FAULT_FILE   calls count when the file's path holds this text; ending in $: when the path ends so
//   FAULT_CALL   write, rename (before it), renamed (after it), fsync, or alloc (of memory, for which FAULT_FILE does not count)
//   FAULT_SIZE   alloc: the smallest that counts, bytes (default 65536)
//   FAULT_AT     the call that is struck, from 1 (default 1)
//   FAULT        kill (SIGKILL), term (SIGTERM), hup, xcpu, usr1, usr2, stop (SIGSTOP), full (this and all later calls fail with
//   ENOSPC; writes to be struck take
//                what still fits) or a number, an errno of this one call
//   FAULT_SPACE  full, in place of FAULT_AT: bytes that may be written to these files before
//   FAULT_LOG    a line is appended to this file when the fault strikes
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/uio.h>
#include <unistd.h>

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static long calls = 0, bytes = 0;

static const char* setting(const char* name) {
  const char* value = getenv(name);
  return value ? value : "";
}

static void* next(const char* name) { return dlsym(RTLD_NEXT, name); }

static void tell(const char* call, const char* path) {
  const char* log = setting("FAULT_LOG");
  if (!*log) return;
  char line[4352];
  const int length = snprintf(line, sizeof line, "%s %s %s\n", setting("FAULT"), call, path);
  const int file = open(log, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  ssize_t (*write_on)(int, const void*, size_t) = next("write");
  if (file >= 0) {
    if (write_on(file, line, (size_t)length) < 0) abort();
    close(file);
  }
}

static int fits(const char* path, const char* file) {
  const size_t length = strlen(file), all = strlen(path);
  if (length == 0 || file[length - 1] != '$') return length > 0 && strstr(path, file) != NULL;
  return all >= length - 1 && strncmp(path + all - (length - 1), file, length - 1) == 0;
}

static int concerns(const char* call, const char* path) {
  return strcmp(setting("FAULT_CALL"), call) == 0 && fits(path, setting("FAULT_FILE"));
}

// Is this call, which concerns us, struck? Of a disk that fills, `size` is cut to what still fits.
static int strikes(size_t* size) {
  const char* space = setting("FAULT_SPACE");
  const int full = strcmp(setting("FAULT"), "full") == 0;
  pthread_mutex_lock(&lock);
  const long at = *setting("FAULT_AT") ? atol(setting("FAULT_AT")) : 1, now = ++calls;
  int struck = full ? now >= at : now == at;
  if (full && *space && size) {
    const long left = atol(space) - bytes;
    struck = left <= 0;
    if (!struck && (long)*size > left) *size = (size_t)left;
    if (!struck) bytes += (long)*size;
  }
  pthread_mutex_unlock(&lock);
  return struck;
}

// What a struck call does: it may not come back, may go on (0), or returns the errno to fail with.
static int fault(const char* call, const char* path) {
  const char* what = setting("FAULT");
  tell(call, path);
  if (strcmp(what, "kill") == 0) kill(getpid(), SIGKILL);
  if (strcmp(what, "term") == 0) kill(getpid(), SIGTERM);
  if (strcmp(what, "hup") == 0) kill(getpid(), SIGHUP);
  if (strcmp(what, "xcpu") == 0) kill(getpid(), SIGXCPU);
  if (strcmp(what, "usr1") == 0) kill(getpid(), SIGUSR1);
  if (strcmp(what, "usr2") == 0) kill(getpid(), SIGUSR2);
  if (strcmp(what, "stop") == 0) kill(getpid(), SIGSTOP);
  if (strcmp(what, "full") == 0) return ENOSPC;
  return atoi(what);
}

static int fails(const char* call, const char* path, size_t* size) {
  const int error = concerns(call, path) && strikes(size) ? fault(call, path) : 0;
  if (error) errno = error;
  return error != 0;
}

static const char* path_of(int file, char* path, size_t size) {
  char link[64];
  snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  const ssize_t length = readlink(link, path, size - 1);
  path[length > 0 ? length : 0] = 0;
  return path;
}

static int write_fails(int file, size_t* size) {
  char path[4096];
  if (!*setting("FAULT_FILE") || strcmp(setting("FAULT_CALL"), "write") != 0) return 0;
  return fails("write", path_of(file, path, sizeof path), size);
}

ssize_t write(int file, const void* data, size_t size) {
  ssize_t (*go_on)(int, const void*, size_t) = next("write");
  return write_fails(file, &size) ? -1 : go_on(file, data, size);
}

ssize_t pwrite(int file, const void* data, size_t size, off_t at) {
  ssize_t (*go_on)(int, const void*, size_t, off_t) = next("pwrite");
  return write_fails(file, &size) ? -1 : go_on(file, data, size, at);
}

ssize_t pwrite64(int file, const void* data, size_t size, off64_t at) {
  ssize_t (*go_on)(int, const void*, size_t, off64_t) = next("pwrite64");
  return write_fails(file, &size) ? -1 : go_on(file, data, size, at);
}

ssize_t writev(int file, const struct iovec* data, int n) {
  ssize_t (*go_on)(int, const struct iovec*, int) = next("writev");
  size_t size = 0;
  for (int i = 0; i < n; ++i) size += data[i].iov_len;
  const size_t all = size;
  if (write_fails(file, &size)) return -1;
  return size < all ? (errno = ENOSPC, -1) : go_on(file, data, n);
}

size_t fwrite(const void* data, size_t size, size_t n, FILE* file) {
  size_t (*go_on)(const void*, size_t, size_t, FILE*) = next("fwrite");
  size_t all = size * n;
  const size_t wanted = all;
  if (write_fails(fileno(file), &all)) return 0;
  return all < wanted ? (errno = ENOSPC, 0) : go_on(data, size, n, file);
}

int rename(const char* from, const char* to) {
  int (*go_on)(const char*, const char*) = next("rename");
  if (fails("rename", to, NULL)) return -1;
  const int result = go_on(from, to);
  if (result == 0) fails("renamed", to, NULL);
  return result;
}

int fsync(int file) {
  int (*go_on)(int) = next("fsync");
  char path[4096];
  if (concerns("fsync", path_of(file, path, sizeof path)) && fails("fsync", path, NULL)) return -1;
  return go_on(file);
}

#ifndef FAULTS_LEAVE_MEMORY  // to sanitizers, which have allocations of their own
// glibc's own functions; dlsym allocates itself.
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t n, size_t size);
void* __libc_realloc(void* old, size_t size);
void* __libc_memalign(size_t alignment, size_t size);

// The solution phase of MUMPS 5.5 goes on with an array that it has no memory for, and ends with a segmentation fault: its
// own allocations are left to it.
static int is_mumps(const void* caller) {
  Dl_info of;
  return dladdr(caller, &of) && strstr(of.dli_fname, "mumps");
}

static int alloc_fails(size_t size, const void* caller) {
  static __thread int within = 0;
  if (within || strcmp(setting("FAULT_CALL"), "alloc") != 0) return 0;
  const char* least = setting("FAULT_SIZE");
  if (size < (*least ? (size_t)atol(least) : 65536) || is_mumps(caller)) return 0;
  within = 1;
  char what[64];
  snprintf(what, sizeof what, "%zu bytes", size);
  const int error = strikes(NULL) ? fault("alloc", what) : 0;
  within = 0;
  if (error) errno = ENOMEM;
  return error != 0;
}

void* malloc(size_t size) { return alloc_fails(size, __builtin_return_address(0)) ? NULL : __libc_malloc(size); }

void* calloc(size_t n, size_t size) {
  return n > 0 && size <= SIZE_MAX / n && alloc_fails(n * size, __builtin_return_address(0)) ? NULL : __libc_calloc(n, size);
}

void* realloc(void* old, size_t size) { return alloc_fails(size, __builtin_return_address(0)) ? NULL : __libc_realloc(old, size); }

void* aligned_alloc(size_t alignment, size_t size) {
  return alloc_fails(size, __builtin_return_address(0)) ? NULL : __libc_memalign(alignment, size);
}

int posix_memalign(void** memory, size_t alignment, size_t size) {
  if (alloc_fails(size, __builtin_return_address(0))) return ENOMEM;
  *memory = __libc_memalign(alignment, size);
  return *memory ? 0 : ENOMEM;
}
#endif
