#include "io/body/flexibility_group.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "elastogear/base/error.h"
#include "elastogear/base/finite.h"

#include "elastogear/io/body_file.h"
#include "io/hdf5/schema.h"

namespace elastogear::io {
namespace {

const std::string kGroup = "/flexibility";

void write_images(const h5::File& file, const std::string& name, const model::Images& images) {
  h5::make_group(file, kGroup + name);
  h5::write<int>(file, kGroup + name + "/orbit", view(images.orbit), "1");
  h5::write<int>(file, kGroup + name + "/turns", view(images.sector_index), "1");
}

model::Images read_images(const h5::File& file, const std::string& name, int n_sectors) {
  return model::make_images(h5::read<int>(file, kGroup + name + "/orbit", {h5::kAny}),
                            h5::read<int>(file, kGroup + name + "/turns", {h5::kAny}), n_sectors,
                            file.path + ": " + kGroup + name);
}

// A row of the dataset is a column of the matrix, in single precision. No rows: no dataset.
h5::Id create_columns(const h5::File& file, const std::string& name, hsize_t rows, hsize_t n,
                      const std::string& unit) {
  if (rows == 0 || n == 0) return {};
  return h5::create_chunked(file, kGroup + name, {{n, rows}, {1, rows}, unit, true});
}

void write_next(const h5::File& file, hid_t dataset, hsize_t first, const Eigen::MatrixXf& A) {
  if (A.size() == 0) return;
  h5::write_rows(file, dataset, {first, {extent(A.cols()), extent(A.rows())}}, A.data());
}

void write_columns(const h5::File& file, const std::string& name, const Eigen::MatrixXf& A,
                   const std::string& unit) {
  write_next(file, create_columns(file, name, extent(A.rows()), extent(A.cols()), unit), 0, A);
}

Eigen::MatrixXf read_columns(const h5::File& file, const std::string& name, hsize_t first, hsize_t n) {
  const h5::Shape shape = h5::shape(file, kGroup + name);
  require(shape.size() == 2 && first + n <= shape[0], file.path, ": ", kGroup, name,
          " must have a row for each of ", first + n, " forces");
  Eigen::MatrixXf A(static_cast<Eigen::Index>(shape[1]), static_cast<Eigen::Index>(n));
  h5::read_rows(file, kGroup + name, {first, {n, shape[1]}}, A.data());
  return A;
}

// A number of the group that files may lack.
int number_or(const h5::File& file, const std::string& name, int missing) {
  if (!h5::has_attribute(file, kGroup, name)) return missing;
  const std::vector<int> numbers = h5::int_attribute(file, kGroup, name);
  require(numbers.size() == 1, file.path, ": ", kGroup, ": attribute ", name, " must be one number");
  return numbers.front();
}

// Reads the columns of an orbit when they are asked for. The file is kept open: one that takes its place
// while a run reads on is another body's.
std::function<Eigen::MatrixXf(int)> reader(const std::shared_ptr<const h5::File>& body,
                                           const std::string& name, const model::Flexibility& flexibility) {
  const auto n_orbits = static_cast<hsize_t>(flexibility.surface.node.cols());
  require(h5::shape(*body, kGroup + name) == h5::Shape{3 * n_orbits, 3 * flexibility.node.size()}, body->path,
          ": ", kGroup, name, " must have a row for each force and a column for each displacement");
  return [body, name](int orbit) { return read_columns(*body, name, 3 * static_cast<hsize_t>(orbit), 3); };
}

void write_relaxed(const h5::File& file, const model::Flexibility& flexibility) {
  if (flexibility.relaxed.empty()) return;
  const model::DenseRows law = flexibility.law;
  h5::write<double>(file, kGroup + "/law", {{extent(law.rows()), extent(law.cols())}, law.data()}, "1");
  h5::make_group(file, kGroup + "/relaxed");
  for (std::size_t i = 0; i < flexibility.relaxed.size(); ++i) {
    const model::RelaxedResponse& relaxed = flexibility.relaxed[i];
    const std::string name = "/relaxed/" + std::to_string(i);
    h5::make_group(file, kGroup + name);
    h5::write<double>(file, kGroup + name + "/share", view(relaxed.share), "1");
    h5::write<double>(file, kGroup + name + "/self", view(relaxed.self), "m/N");
    write_columns(file, name + "/F", relaxed.F, "m/N");
  }
}

void read_relaxed(const h5::File& file, const std::shared_ptr<const h5::File>& body,
                  model::Flexibility& flexibility) {
  require(!h5::exists(file, kGroup + "/F_long"), file.path,
          ": holds static responses of the relaxed body alone, as programs before version 4 of body files "
          "wrote them: reduce the body again");
  if (!h5::exists(file, kGroup + "/law")) return;
  const h5::Shape shape = h5::shape(file, kGroup + "/law");
  require(shape.size() == 2, file.path, ": ", kGroup, "/law must have two dimensions");
  const std::vector<double> law = h5::read<double>(file, kGroup + "/law", {shape[0], shape[1]});
  flexibility.law = Eigen::Map<const model::DenseRows>(law.data(), static_cast<Eigen::Index>(shape[0]),
                                                       static_cast<Eigen::Index>(shape[1]));
  for (std::size_t i = 0; h5::exists(file, kGroup + "/relaxed/" + std::to_string(i)); ++i) {
    const std::string name = "/relaxed/" + std::to_string(i);
    model::RelaxedResponse relaxed{read_vector(file, kGroup + name + "/share"),
                                   read_vector(file, kGroup + name + "/self")};
    relaxed.read_F = reader(body, name + "/F", flexibility);
    flexibility.relaxed.push_back(std::move(relaxed));
  }
}

}  // namespace

ResponseColumns create_responses(const h5::File& file, const model::Flexibility& plan,
                                 const Eigen::MatrixXf& F, const Eigen::MatrixXf& G) {
  const auto n = 3 * extent(plan.surface.node.cols());
  h5::make_group(file, kGroup);
  return {create_columns(file, "/F", extent(F.rows()), n, "m/N"),
          create_columns(file, "/G", extent(G.rows()), n, "Pa/N"), 0, n};
}

void write_responses(const h5::File& file, ResponseColumns& columns, const Eigen::MatrixXf& F,
                     const Eigen::MatrixXf& G) {
  require(columns.n_written + extent(F.cols()) <= columns.n_columns, file.path, ": ", kGroup, " has ",
          columns.n_columns, " forces, responses came to more");
  require(all_finite(F) && all_finite(G), file.path, ": static responses are not finite");
  write_next(file, columns.F, columns.n_written, F);
  write_next(file, columns.G, columns.n_written, G);
  columns.n_written += extent(F.cols());
}

Eigen::MatrixXf read_displacement_responses(const h5::File& file, int orbit) {
  return read_columns(file, "/F", 3 * static_cast<hsize_t>(orbit), 3);
}

void write_flexibility(const h5::File& file, const model::Flexibility& flexibility) {
  if (flexibility.empty()) return;
  if (!h5::exists(file, kGroup)) h5::make_group(file, kGroup);
  h5::set_attribute(file, kGroup, "n_sectors", flexibility.n_sectors);
  h5::write<double>(file, kGroup + "/axis", {{3}, flexibility.axis.data()}, "1");
  h5::write<int>(file, kGroup + "/node", view(flexibility.node), "1");
  write_images(file, "/surface", flexibility.surface);
  write_images(file, "/stress", flexibility.stress);
  h5::write<int>(file, kGroup + "/stress/row", view(flexibility.stress_row), "1");
  h5::write<double>(file, kGroup + "/self", view(flexibility.self), "m/N");
  write_columns(file, "/F", flexibility.F, "m/N");
  write_columns(file, "/G", flexibility.G, "Pa/N");
  if (flexibility.creep >= 0) h5::set_attribute(file, kGroup, "creep", flexibility.creep);
  write_relaxed(file, flexibility);
}

model::Flexibility read_flexibility(const h5::File& file) {
  model::Flexibility flexibility;
  if (!h5::exists(file, kGroup)) return flexibility;
  const std::vector<int> n_sectors = h5::int_attribute(file, kGroup, "n_sectors");
  require(n_sectors.size() == 1, file.path, ": ", kGroup, ": attribute n_sectors must be one number");
  flexibility.n_sectors = n_sectors.front();
  flexibility.axis = Eigen::Map<const Eigen::Vector3d>(h5::read<double>(file, kGroup + "/axis", {3}).data());
  flexibility.node = h5::read<int>(file, kGroup + "/node", {h5::kAny});
  flexibility.surface = read_images(file, "/surface", flexibility.n_sectors);
  flexibility.stress = read_images(file, "/stress", flexibility.n_sectors);
  flexibility.stress_row = h5::read<int>(file, kGroup + "/stress/row", {h5::kAny});
  const auto n_orbits = static_cast<hsize_t>(flexibility.surface.node.cols());
  flexibility.self = read_vector(file, kGroup + "/self", n_orbits);
  const auto body = std::make_shared<const h5::File>(open_format(file.path, kBodyFormat));
  flexibility.read_F = reader(body, "/F", flexibility);
  flexibility.creep = number_or(file, "creep", -1);
  read_relaxed(file, body, flexibility);
  return flexibility;
}

Eigen::MatrixXf read_stress_responses(const std::string& path, int orbit) {
  const h5::File file = open_format(path, kBodyFormat);
  return read_columns(file, "/G", 3 * static_cast<hsize_t>(orbit), 3);
}

}  // namespace elastogear::io
