#include "io/hdf5/hdf5.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "elastogear/base/file.h"
#include "io/hdf5/hdf5_objects.h"
#include "io/hdf5/write_driver.h"

namespace elastogear::io::h5 {
namespace {

// Attributes go to other storage beyond this number.
constexpr unsigned kMostAttributes = 65535;

void silence() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

// Layouts since HDF5 1.10 have checksums on everything that describes the data.
Id access_properties() {
  Id properties(H5Pcreate(H5P_FILE_ACCESS));
  H5Pset_libver_bounds(properties, H5F_LIBVER_V110, H5F_LIBVER_LATEST);
  use_write_driver(properties);
  return properties;
}

// A file system without locks is no hindrance.
Id read_properties() {
  Id properties(H5Pcreate(H5P_FILE_ACCESS));
  H5Pset_file_locking(properties, true, true);
  return properties;
}

// HDF5 locks a file that it opens, for all readers or for one writer.
bool has_writer(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const bool locked = file >= 0 && flock(file, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  if (file >= 0) ::close(file);
  return locked;
}

herr_t collect(hid_t, const char* name, const H5L_info_t*, void* names) {
  static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}

}  // namespace

void keep_attributes_in_header(hid_t creation_properties) {
  H5Pset_attr_phase_change(creation_properties, kMostAttributes, 0);
  H5Pset_obj_track_times(creation_properties, false);
}

Id link_properties() {
  Id properties(H5Pcreate(H5P_LINK_CREATE));
  H5Pset_create_intermediate_group(properties, 1);
  return properties;
}

File create(const std::string& path, const std::string& temporary) {
  silence();
  take_close_failure();  // of a file that was given up
  const Id creation(H5Pcreate(H5P_FILE_CREATE));
  keep_attributes_in_header(creation);
  File file{path, Id(H5Fcreate(temporary.c_str(), H5F_ACC_TRUNC, creation, access_properties()))};
  if (file.id < 0) fail_to_write(path, write_error(errno));
  return file;
}

File open(const std::string& path) {
  silence();
  require_file(path);
  require(access(path.c_str(), R_OK) == 0, path, ": cannot be read: ", std::strerror(errno));
  require(H5Fis_hdf5(path.c_str()) > 0, path, ": is no HDF5 file, or is truncated or damaged");
  File file{path, Id(H5Fopen(path.c_str(), H5F_ACC_RDONLY, read_properties()))};
  require(file.id >= 0 || !has_writer(path), path,
          ": another program has it open to write: close it there, then give the same command again");
  require(file.id >= 0, path, ": cannot be opened: the HDF5 file is truncated or damaged");
  return file;
}

File open_to_add(const std::string& path) {
  silence();
  File file{path, Id(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT))};
  if (file.id < 0) fail_to_write(path, "cannot be opened to add to it");
  return file;
}

void close(File& file) {
  check_written(H5Fflush(file.id, H5F_SCOPE_LOCAL) >= 0, file, "/");
  file.id = Id();
  const std::string failure = take_close_failure();
  if (!failure.empty()) fail_to_write(file.path, failure);
}

void check(bool good, const File& file, const std::string& object, const char* what) {
  if (!good) fail(file.path, ": ", object, ": ", what);
}

void check_written(bool good, const File& file, const std::string& object) {
  const std::string failure = write_failure(file.id);
  if (!failure.empty()) fail_to_write(file.path, failure);
  check(good, file, object, "cannot be written");
}

void damaged(const File& file, const std::string& what) {
  fail(file.path, ": damaged: ", what, ". Make the file again or take a copy of it");
}

bool is_group(const File& file, const std::string& name) {
  return H5Iget_type(open_object(file, name)) == H5I_GROUP;
}

// HDF5's own check fails on a path whose parents are missing or no groups.
bool exists(const File& file, const std::string& name) {
  if (name == "/") return true;
  for (std::size_t slash = name.find('/', 1);; slash = name.find('/', slash + 1)) {
    const std::string part = name.substr(0, slash);
    const htri_t found = H5Lexists(file.id, part.c_str(), H5P_DEFAULT);
    if (found < 0) damaged(file, "the group of " + part);
    if (found == 0) return false;
    if (slash == std::string::npos) return true;
    if (!is_group(file, part)) return false;
  }
}

Id open_object(const File& file, const std::string& name) {
  if (name != "/" && !exists(file, name)) fail(file.path, ": there is no ", name);
  Id object(H5Oopen(file.id, name.c_str(), H5P_DEFAULT));
  if (object < 0) damaged(file, "header of " + name);
  return object;
}

void make_group(const File& file, const std::string& name) {
  const Id creation(H5Pcreate(H5P_GROUP_CREATE));
  keep_attributes_in_header(creation);
  const Id group(H5Gcreate2(file.id, name.c_str(), link_properties(), creation, H5P_DEFAULT));
  check_written(group >= 0, file, name);
}

std::vector<std::string> members(const File& file, const std::string& group) {
  const Id object = open_object(file, group);
  check(H5Iget_type(object) == H5I_GROUP, file, group, "is not a group");
  std::vector<std::string> names;
  if (H5Literate(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, collect, &names) < 0)
    damaged(file, "the group " + group);
  return names;
}

std::vector<std::string> datasets(const File& file) {
  std::vector<std::string> names;
  const auto add = [](hid_t, const char* name, const H5O_info_t* info, void* data) -> herr_t {
    if (info->type == H5O_TYPE_DATASET)
      static_cast<std::vector<std::string>*>(data)->emplace_back("/") += name;
    return 0;
  };
  if (H5Ovisit(file.id, H5_INDEX_NAME, H5_ITER_INC, add, &names) < 0) damaged(file, "the tree of groups");
  return names;
}

}  // namespace elastogear::io::h5
