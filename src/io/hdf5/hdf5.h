#pragma once
// The HDF5 library held, not wrapped: one RAII handle, and whole datasets and attributes by path. Errors name
// the file and the object; HDF5 itself prints nothing. Serial access, also in the parallel build of HDF5. All
// that is written has checksums, which are verified whenever it is read.

#include <Eigen/Core>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "elastogear/base/error.h"
#include "io/hdf5/hdf5_api.h"

namespace elastogear::io::h5 {

/// Owner of any HDF5 object.
class Id {
 public:
  Id() = default;
  explicit Id(hid_t id) : id_(id) {}
  Id(Id&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)) {}
  Id& operator=(Id&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  Id(const Id&) = delete;
  Id& operator=(const Id&) = delete;
  /// At the end of a process HDF5 may have closed all of its objects before.
  ~Id() {
    if (id_ >= 0 && H5Iis_valid(id_) > 0) H5Idec_ref(id_);
  }
  operator hid_t() const { return id_; }

 private:
  hid_t id_ = H5I_INVALID_HID;
};

struct File {
  std::string path;  ///< named in errors
  Id id;
};

/// New file at `temporary`; errors name `path`.
File create(const std::string& path, const std::string& temporary);
/// Existing file, read only. Error when it is missing, truncated or no HDF5 file.
File open(const std::string& path);
/// Existing file, to which objects are added; what is there stays.
File open_to_add(const std::string& path);
/// WriteFailure when something could not be written.
void close(File& file);

/// Error naming file and object unless `good`.
void check(bool good, const File& file, const std::string& object, const char* what);
/// WriteFailure unless `good` and all that was written to a file of create() has reached it.
void check_written(bool good, const File& file, const std::string& object);
/// Error: the file has changed since it was written; `what` says where: "checksum of /reduced/K".
[[noreturn]] void damaged(const File& file, const std::string& what);

bool exists(const File& file, const std::string& name);
bool is_group(const File& file, const std::string& name);
void make_group(const File& file, const std::string& name);
/// Names of the members of a group, ascending.
std::vector<std::string> members(const File& file, const std::string& group);
/// Paths of all datasets, ascending.
std::vector<std::string> datasets(const File& file);

using Shape = std::vector<hsize_t>;

/// Row-major numbers in memory. Eigen's 3 x n column-major matrices are n x 3 here.
template <class T>
struct View {
  Shape shape;
  const T* data;
};

/// T: double or int. `unit`: "m", "N", ...; "1" for none. Rows are chunks, each with a checksum.
template <class T>
void write(const File& file, const std::string& name, const View<T>& view, const std::string& unit,
           bool compress = false);
/// A matrix in compressed square chunks. Those that are all zeros are not stored, and are read as zeros.
void write_blocks(const File& file, const std::string& name, const View<double>& matrix,
                  const std::string& unit);
void write_strings(const File& file, const std::string& name, const std::vector<std::string>& strings);

/// Rows of a dataset that are stored together, or as many as would be.
hsize_t rows_together(const File& file, const std::string& name);
Shape shape(const File& file, const std::string& name);
/// Error unless the dataset is numeric, undamaged, finite and of this shape; kAny allows any extent.
constexpr hsize_t kAny = H5S_UNLIMITED;
enum class Finite { required, any };
template <class T>
std::vector<T> read(const File& file, const std::string& name, const Shape& expected,
                    Finite finite = Finite::required);
std::vector<std::string> read_strings(const File& file, const std::string& name);
/// Does the dataset hold text?
bool holds_text(const File& file, const std::string& name);
std::string unit(const File& file, const std::string& name);

/// Attributes of the object `name` ("/" for the root).
bool has_attribute(const File& file, const std::string& name, const std::string& key);
void set_attribute(const File& file, const std::string& name, const std::string& key,
                   const std::string& value);
void set_attribute(const File& file, const std::string& name, const std::string& key, double value);
void set_attribute(const File& file, const std::string& name, const std::string& key, int value);
void set_attribute(const File& file, const std::string& name, const std::string& key,
                   const std::vector<int>& value);
std::string string_attribute(const File& file, const std::string& name, const std::string& key);
double number_attribute(const File& file, const std::string& name, const std::string& key);
/// One number or a row of numbers.
std::vector<int> int_attribute(const File& file, const std::string& name, const std::string& key);

/// A group whose attributes are the map.
void write_map(const File& file, const std::string& group, const std::map<std::string, std::string>& map);
std::map<std::string, std::string> read_map(const File& file, const std::string& group);

/// Rows first .. first + count[0] - 1 of a dataset, which is read or written piece by piece.
struct Rows {
  hsize_t first;
  Shape count;  ///< of all dimensions
};
struct Chunked {
  Shape shape, chunk;
  std::string unit;
  bool single = false;  ///< 4 bytes a number
};
Id create_chunked(const File& file, const std::string& name, const Chunked& layout);
/// T: double, or float for numbers of 4 bytes, which then are not converted.
template <class T>
void write_rows(const File& file, hid_t dataset, const Rows& rows, const T* data);
/// Error when the numbers are damaged or not finite.
template <class T>
void read_rows(const File& file, const std::string& name, const Rows& rows, T* data);

/// Calls visit(row, its numbers) for all rows of a dataset of real numbers, chunk by chunk: no more than one
/// chunk is in memory. Error when they are damaged or not finite.
void visit_rows(const File& file, const std::string& name,
                const std::function<void(hsize_t row, const double* numbers)>& visit);

/// Shape and unit of the rows of a Series.
struct Item {
  Shape shape;  ///< of one row; empty: a number
  std::string unit;
  bool integer = false;
  bool single = false;  ///< 4 bytes a number
};

/// A dataset without rows, to be extended.
Id create_growing(const File& file, const std::string& name, const Item& item, hsize_t rows_per_chunk);
/// The shape of such a dataset from now on.
void set_shape(const File& file, hid_t dataset, const Shape& shape);

/// One growing dataset, n_rows x item shape, written in blocks. The file must outlive it.
class Series {
 public:
  Series(const File& file, std::string name, Item item);
  /// `rows` rows, row-major.
  void append(const double* data, hsize_t rows = 1);
  /// Writes what is still buffered.
  void flush();
  const Item& item() const { return item_; }

 private:
  void write_first(hsize_t rows);

  const File* file_;
  std::string name_;
  Item item_;
  hsize_t item_size_ = 1, block_ = 1, rows_ = 0;
  Id dataset_;
  std::vector<double> buffer_;
};

}  // namespace elastogear::io::h5
