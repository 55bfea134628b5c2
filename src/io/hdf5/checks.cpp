#include "io/hdf5/checks.h"

#include <sstream>

#include "elastogear/base/text.h"
#include "elastogear/model/elastic_body.h"
#include "io/hdf5/schema.h"

namespace elastogear::io {
namespace {

const std::string kGroup = "/checks";

// Names of rows are one attribute, a line each.
std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

model::Check read_check(const h5::File& file, const std::string& name) {
  const std::string path = kGroup + "/" + name;
  // Shares of nothing, of directions that are held at all nodes, are no numbers.
  const auto values = h5::read<double>(file, path, {h5::kAny, h5::kAny}, h5::Finite::any);
  const h5::Shape shape = h5::shape(file, path);
  model::Check check{name, h5::unit(file, path), h5::string_attribute(file, path, "meaning"), {}};
  check.value = Eigen::Map<const model::DenseRows>(values.data(), static_cast<Eigen::Index>(shape[0]),
                                                   static_cast<Eigen::Index>(shape[1]));
  check.row = split(h5::string_attribute(file, path, "rows"));
  require(check.row.empty() || check.row.size() == shape[0], file.path, ": ", path, " has ", shape[0],
          " rows and ", check.row.size(), " names of rows");
  return check;
}

}  // namespace

void write_checks(const h5::File& file, const std::vector<model::Check>& checks) {
  if (!h5::exists(file, kGroup)) h5::make_group(file, kGroup);
  for (const model::Check& check : checks) {
    require_name(file, check.name);
    const std::string path = kGroup + "/" + check.name;
    const model::DenseRows value = check.value;
    h5::write<double>(
        file, path, {{static_cast<hsize_t>(value.rows()), static_cast<hsize_t>(value.cols())}, value.data()},
        check.unit);
    h5::set_attribute(file, path, "meaning", check.meaning);
    h5::set_attribute(file, path, "rows", join(check.row, "\n"));
  }
}

std::vector<model::Check> read_checks(const h5::File& file) {
  std::vector<model::Check> checks;
  if (!h5::exists(file, kGroup)) return checks;
  for (const std::string& name : h5::members(file, kGroup))
    if (h5::shape(file, kGroup + "/" + name).size() == 2) checks.push_back(read_check(file, name));
  return checks;
}

}  // namespace elastogear::io
