#pragma once
// Matrices of a body file: dense datasets in a modal basis, compressed sparse rows in the full basis.

#include "elastogear/model/elastic_body.h"
#include "io/hdf5/schema.h"

namespace elastogear::io {

/// Rows of a basis, n x block x n_q: dense as one dataset, sparse as a group {data, indices, indptr} with the
/// attribute shape = (n block, n_q).
void write_rows(const h5::File& file, const std::string& name, const model::BasisRows& rows, int block,
                const std::string& unit);
model::BasisRows read_rows(const h5::File& file, const std::string& name, int block);

void write_sparse(const h5::File& file, const std::string& group, const model::SparseRows& A,
                  const std::string& unit);
/// Error unless the rows are consistent, with ascending column numbers in range.
model::SparseRows read_sparse(const h5::File& file, const std::string& group);

/// One matrix, dense as a dataset of rows x columns or sparse as a group.
void write_matrix(const h5::File& file, const std::string& name, const model::BasisRows& matrix,
                  const std::string& unit);
model::BasisRows read_matrix(const h5::File& file, const std::string& name);

/// n_q x n_q, dense and compressed for a modal basis, sparse for the full basis.
void write_square(const h5::File& file, const std::string& name, const Eigen::SparseMatrix<double>& A,
                  const std::pair<model::Basis, std::string>& basis_and_unit);
Eigen::SparseMatrix<double> read_square(const h5::File& file, const std::string& name);

}  // namespace elastogear::io
