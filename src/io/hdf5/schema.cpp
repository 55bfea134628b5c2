#include "io/hdf5/schema.h"

#include <algorithm>

namespace elastogear::io {

void write_format(const h5::File& file, const Format& format) {
  h5::set_attribute(file, "/", "format", std::string(format.name));
  h5::set_attribute(file, "/", "version", format.version);
}

int version(const h5::File& file) { return h5::int_attribute(file, "/", "version").front(); }

h5::File open_format(const std::string& path, const Format& format) {
  h5::File file = h5::open(path);
  const std::string found = h5::string_attribute(file, "/", "format");
  require(found == format.name, path, ": has the format '", found, "', must be '", format.name, "'");
  const int found_version = version(file);
  require(found_version >= format.oldest && found_version <= format.version, path, ": has version ",
          found_version, " of the format '", format.name, "', this program reads versions ", format.oldest,
          " to ", format.version);
  return file;
}

bool read_flag(const h5::File& file, const std::string& object, const std::string& key) {
  const std::vector<int> flag = h5::int_attribute(file, object, key);
  require(flag.size() == 1 && (flag[0] == 0 || flag[0] == 1), file.path, ": ", object, ": attribute ", key,
          " must be 0 or 1");
  return flag[0] == 1;
}

void require_name(const h5::File& file, const std::string& name) {
  require(!name.empty() && name != "." && name.find('/') == std::string::npos, file.path, ": the name '",
          name, "' cannot be stored: it must not be empty, '.' or hold a slash");
}

Eigen::Matrix3Xd read_points(const h5::File& file, const std::string& name) {
  const auto values = h5::read<double>(file, name, {h5::kAny, 3});
  return Eigen::Map<const Eigen::Matrix3Xd>(values.data(), 3, static_cast<Eigen::Index>(values.size() / 3));
}

Eigen::VectorXd read_vector(const h5::File& file, const std::string& name, hsize_t size) {
  const auto values = h5::read<double>(file, name, {size});
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

Eigen::VectorXd read_time(const h5::File& file) {
  Eigen::VectorXd time = read_vector(file, "/time");
  const auto step = std::adjacent_find(time.begin(), time.end(), std::greater_equal<>());
  require(step == time.end(), file.path, ": /time does not increase: ", *step, " s is followed by ",
          *(step + 1), " s");
  return time;
}

}  // namespace elastogear::io
