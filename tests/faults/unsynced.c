// A library to preload (LD_PRELOAD) into programs under test: files and folders are not written through to
// the disk. No test cuts the power, and waiting for the disk is most of the time of some.
#include <errno.h>
#include <sys/stat.h>
#include <unistd.h>

int fsync(int file) {
  struct stat of;
  if (fstat(file, &of) != 0) return -1;
  if (S_ISREG(of.st_mode) || S_ISDIR(of.st_mode)) return 0;
  errno = EINVAL;  // pipes, terminals and sockets cannot be synced
  return -1;
}
