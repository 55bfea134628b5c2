#include "io/body/basis_rows.h"

#include <algorithm>
#include <cstddef>

#include "elastogear/base/memory.h"
#include "io/hdf5/schema.h"

namespace elastogear::io {
namespace {

using model::DenseRows;
using model::SparseRows;

bool is_sparse(const h5::File& file, const std::string& name) { return h5::exists(file, name + "/indptr"); }

}  // namespace

void write_sparse(const h5::File& file, const std::string& group, const SparseRows& A,
                  const std::string& unit) {
  SparseRows rows = A;
  rows.makeCompressed();
  h5::make_group(file, group);
  h5::set_attribute(file, group, "shape",
                    std::vector{static_cast<int>(rows.rows()), static_cast<int>(rows.cols())});
  const hsize_t n = extent(rows.nonZeros());
  h5::write<double>(file, group + "/data", {{n}, rows.valuePtr()}, unit);
  h5::write<int>(file, group + "/indices", {{n}, rows.innerIndexPtr()}, "1");
  h5::write<int>(file, group + "/indptr", {{extent(rows.rows() + 1)}, rows.outerIndexPtr()}, "1");
}

SparseRows read_sparse(const h5::File& file, const std::string& group) {
  const std::vector<int> shape = h5::int_attribute(file, group, "shape");
  require(shape.size() == 2 && shape[0] >= 0 && shape[1] >= 0, file.path, ": ", group,
          ": attribute shape must be two numbers");
  const auto indptr = h5::read<int>(file, group + "/indptr", {extent(shape[0]) + 1});
  const auto indices = h5::read<int>(file, group + "/indices", {h5::kAny});
  const auto data = h5::read<double>(file, group + "/data", {indices.size()});
  bool good = indptr.front() == 0 && indptr.back() == static_cast<int>(indices.size()) &&
              std::is_sorted(indptr.begin(), indptr.end());
  for (std::size_t row = 0; good && row + 1 < indptr.size(); ++row) {
    const auto first = indices.begin() + indptr[row], last = indices.begin() + indptr[row + 1];
    // Strictly ascending, in range.
    good = std::adjacent_find(first, last, std::greater_equal<>()) == last &&
           (first == last || (*first >= 0 && *(last - 1) < shape[1]));
  }
  require(good, file.path, ": ", group, ": indptr and indices are no compressed rows of a ", shape[0], " x ",
          shape[1], " matrix");
  return Eigen::Map<const SparseRows>(shape[0], shape[1], static_cast<Eigen::Index>(data.size()),
                                      indptr.data(), indices.data(), data.data());
}

void write_rows(const h5::File& file, const std::string& name, const model::BasisRows& rows, int block,
                const std::string& unit) {
  if (const auto* sparse = std::get_if<SparseRows>(&rows)) return write_sparse(file, name, *sparse, unit);
  const DenseRows& dense = *model::dense_rows(rows);
  h5::write<double>(
      file, name, {{extent(dense.rows() / block), extent(block), extent(dense.cols())}, dense.data()}, unit);
}

model::BasisRows read_rows(const h5::File& file, const std::string& name, int block) {
  if (is_sparse(file, name)) return read_sparse(file, name);
  const h5::Shape shape = h5::shape(file, name);
  require(shape.size() == 3 && shape[1] == extent(block), file.path, ": ", name, " must have the shape n x ",
          block, " x n_q");
  DenseRows rows(static_cast<Eigen::Index>(shape[0]) * block, static_cast<Eigen::Index>(shape[2]));
  if (rows.size() == 0) return rows;
  use_large_pages(rows.data(), sizeof(double) * static_cast<std::size_t>(rows.size()));
  h5::read_rows(file, name, {0, shape}, rows.data());  // gigabytes: no second copy
  return rows;
}

void write_matrix(const h5::File& file, const std::string& name, const model::BasisRows& matrix,
                  const std::string& unit) {
  if (const auto* sparse = std::get_if<SparseRows>(&matrix)) return write_sparse(file, name, *sparse, unit);
  const DenseRows& dense = *model::dense_rows(matrix);
  h5::write<double>(file, name, {{extent(dense.rows()), extent(dense.cols())}, dense.data()}, unit);
}

model::BasisRows read_matrix(const h5::File& file, const std::string& name) {
  if (is_sparse(file, name)) return read_sparse(file, name);
  const auto values = h5::read<double>(file, name, {h5::kAny, h5::kAny});
  const h5::Shape shape = h5::shape(file, name);
  return DenseRows(Eigen::Map<const DenseRows>(values.data(), static_cast<Eigen::Index>(shape[0]),
                                               static_cast<Eigen::Index>(shape[1])));
}

void write_square(const h5::File& file, const std::string& name, const Eigen::SparseMatrix<double>& A,
                  const std::pair<model::Basis, std::string>& basis_and_unit) {
  const auto& [basis, unit] = basis_and_unit;
  if (basis == model::Basis::full) return write_sparse(file, name, A, unit);
  const DenseRows dense = A.toDense();
  h5::write_blocks(file, name, {{extent(dense.rows()), extent(dense.cols())}, dense.data()}, unit);
}

Eigen::SparseMatrix<double> read_square(const h5::File& file, const std::string& name) {
  if (is_sparse(file, name)) return read_sparse(file, name);
  const h5::Shape shape = h5::shape(file, name);
  require(shape.size() == 2, file.path, ": ", name, " must have two dimensions");
  SparseRows A(static_cast<Eigen::Index>(shape[0]), static_cast<Eigen::Index>(shape[1]));
  h5::visit_rows(file, name, [&](hsize_t row, const double* values) {
    A.startVec(static_cast<Eigen::Index>(row));
    for (Eigen::Index column = 0; column < A.cols(); ++column)
      if (values[column] != 0) A.insertBack(static_cast<Eigen::Index>(row), column) = values[column];
  });
  A.finalize();
  return A;
}

}  // namespace elastogear::io
