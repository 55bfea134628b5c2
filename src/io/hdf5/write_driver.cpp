#include "io/hdf5/write_driver.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <new>
#include <utility>
#include <vector>

#include "elastogear/base/file.h"

namespace elastogear::io::h5 {
namespace {

constexpr haddr_t kMaxAddress = (haddr_t{1} << 62) - 1;
// Features of HDF5's own driver for POSIX files.
constexpr unsigned long kFeatures = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA |
                                    H5FD_FEAT_DATA_SIEVE | H5FD_FEAT_AGGREGATE_SMALLDATA |
                                    H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;

struct Unwritten {
  haddr_t address;
  std::vector<char> bytes;
};

// HDF5 holds it as its first member.
struct WrittenFile {
  H5FD_t base = {};
  int descriptor = -1;
  haddr_t end_of_space = 0, end_of_file = 0;
  std::string failure = {};
  std::vector<Unwritten> unwritten = {};  // since the failure, in order
};

std::string close_failure;

WrittenFile& own(H5FD_t* file) { return *reinterpret_cast<WrittenFile*>(file); }
const WrittenFile& own(const H5FD_t* file) { return *reinterpret_cast<const WrittenFile*>(file); }

void note_failure(WrittenFile& file) {
  if (file.failure.empty()) file.failure = write_error(errno);
}

H5FD_t* open_file(const char* name, unsigned flags, hid_t, haddr_t) {
  // A file that is made has a temporary name, under which no link is followed.
  const int mode = O_RDWR | O_CLOEXEC | (flags & H5F_ACC_CREAT ? O_CREAT | O_NOFOLLOW : 0) |
                   (flags & H5F_ACC_TRUNC ? O_TRUNC : 0) | (flags & H5F_ACC_EXCL ? O_EXCL : 0);
  const int descriptor = ::open(name, mode, 0666);
  struct stat status {};
  if (descriptor < 0 || ::fstat(descriptor, &status) != 0) return nullptr;
  auto* const file = new (std::nothrow) WrittenFile;
  if (file == nullptr) return nullptr;
  file->descriptor = descriptor;
  file->end_of_file = static_cast<haddr_t>(status.st_size);
  return &file->base;
}

herr_t close_file(H5FD_t* base) {
  WrittenFile& file = own(base);
  if (::close(file.descriptor) != 0) note_failure(file);
  if (!file.failure.empty()) close_failure = file.failure;
  delete &file;
  return 0;
}

int compare(const H5FD_t* a, const H5FD_t* b) {
  const int x = own(a).descriptor, y = own(b).descriptor;
  return x < y ? -1 : x > y;
}

herr_t query(const H5FD_t*, unsigned long* flags) {
  if (flags != nullptr) *flags = kFeatures;
  return 0;
}

haddr_t end_of_space(const H5FD_t* file, H5FD_mem_t) { return own(file).end_of_space; }

herr_t set_end_of_space(H5FD_t* file, H5FD_mem_t, haddr_t address) {
  own(file).end_of_space = address;
  return 0;
}

haddr_t end_of_file(const H5FD_t* file, H5FD_mem_t) { return own(file).end_of_file; }

herr_t handle(H5FD_t* file, hid_t, void** found) {
  *found = &own(file);
  return 0;
}

// Copies the bytes that the unwritten piece and the wanted range have in common to the buffer.
void overlay(const Unwritten& piece, haddr_t address, std::size_t size, char* buffer) {
  const haddr_t first = std::max(address, piece.address);
  const haddr_t last = std::min(address + size, piece.address + piece.bytes.size());
  if (first < last)
    std::memcpy(buffer + (first - address), piece.bytes.data() + (first - piece.address), last - first);
}

herr_t read_bytes(H5FD_t* base, H5FD_mem_t, hid_t, haddr_t address, std::size_t size, void* data) {
  const WrittenFile& file = own(base);
  auto* const buffer = static_cast<char*>(data);
  for (std::size_t done = 0; done < size;) {
    const ssize_t n =
        ::pread(file.descriptor, buffer + done, size - done, static_cast<off_t>(address + done));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return -1;
    if (n == 0) {  // behind the end
      std::memset(buffer + done, 0, size - done);
      break;
    }
    done += static_cast<std::size_t>(n);
  }
  for (const Unwritten& piece : file.unwritten) overlay(piece, address, size, buffer);
  return 0;
}

herr_t write_bytes(H5FD_t* base, H5FD_mem_t, hid_t, haddr_t address, std::size_t size, const void* data) {
  WrittenFile& file = own(base);
  const auto* const buffer = static_cast<const char*>(data);
  std::size_t done = 0;
  while (done < size && file.failure.empty()) {
    const ssize_t n =
        ::pwrite(file.descriptor, buffer + done, size - done, static_cast<off_t>(address + done));
    if (n > 0) done += static_cast<std::size_t>(n);
    if (n < 0 && errno != EINTR) note_failure(file);
  }
  if (done < size) file.unwritten.push_back({address + done, {buffer + done, buffer + size}});
  file.end_of_file = std::max(file.end_of_file, address + size);
  return 0;
}

herr_t truncate(H5FD_t* base, hid_t, hbool_t) {
  WrittenFile& file = own(base);
  if (file.end_of_file == file.end_of_space) return 0;
  if (file.failure.empty() && ::ftruncate(file.descriptor, static_cast<off_t>(file.end_of_space)) != 0)
    note_failure(file);
  file.end_of_file = file.end_of_space;
  return 0;
}

H5FD_class_t make_class() {
  H5FD_class_t driver{};
  driver.name = "elastogear";
  driver.maxaddr = kMaxAddress;
  driver.fc_degree = H5F_CLOSE_WEAK;
  driver.open = open_file;
  driver.close = close_file;
  driver.cmp = compare;
  driver.query = query;
  driver.get_eoa = end_of_space;
  driver.set_eoa = set_end_of_space;
  driver.get_eof = end_of_file;
  driver.get_handle = handle;
  driver.read = read_bytes;
  driver.write = write_bytes;
  driver.truncate = truncate;
  const H5FD_mem_t map[H5FD_MEM_NTYPES] = H5FD_FLMAP_DICHOTOMY;
  std::copy(std::begin(map), std::end(map), std::begin(driver.fl_map));
#if H5_VERSION_GE(1, 13, 2)
  driver.version = H5FD_CLASS_VERSION;
  driver.value = static_cast<H5FD_class_value_t>(H5_VFD_RESERVED + 77);  // of those for testing
#endif
  return driver;
}

const H5FD_class_t kDriver = make_class();

}  // namespace

// Registered once and for good: H5FD_close() first gives up the file's hold on the driver, and then calls its
// function to close the file, which is gone when no other hold is left. HDF5 forgets the driver when a
// program closes the library and opens it again.
void use_write_driver(hid_t access_properties) {
  static hid_t driver = H5I_INVALID_HID;
  if (H5Iget_type(driver) != H5I_VFL) driver = H5FDregister(&kDriver);
  H5Pset_driver(access_properties, driver, nullptr);
}

std::string write_failure(hid_t file) {
  void* found = nullptr;
  if (H5Fget_vfd_handle(file, H5P_DEFAULT, &found) < 0) return {};
  return static_cast<const WrittenFile*>(found)->failure;
}

std::string take_close_failure() { return std::exchange(close_failure, {}); }

}  // namespace elastogear::io::h5
