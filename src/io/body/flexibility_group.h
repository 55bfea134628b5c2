#pragma once
// Group /flexibility of a body file.

#include "elastogear/model/flexibility.h"
#include "io/hdf5/hdf5.h"

namespace elastogear::io {

/// F and G of a flexibility while their columns are written.
struct ResponseColumns {
  h5::Id F, G;
  hsize_t n_written = 0, n_columns = 0;
};
/// Creates F and G with as many rows as these pieces have.
ResponseColumns create_responses(const h5::File& file, const model::Flexibility& plan,
                                 const Eigen::MatrixXf& F, const Eigen::MatrixXf& G);
/// Writes the next columns. Error when they are more than there are, or not finite.
void write_responses(const h5::File& file, ResponseColumns& columns, const Eigen::MatrixXf& F,
                     const Eigen::MatrixXf& G);

/// The three columns of F of an orbit.
Eigen::MatrixXf read_displacement_responses(const h5::File& file, int orbit);

/// Writes the flexibility, F and G where it has them; an empty one writes nothing.
void write_flexibility(const h5::File& file, const model::Flexibility& flexibility);
/// Reads the flexibility without G; it is empty when the file has none. F is read column by column when it is
/// asked for. The parts fit each other; model::validate compares them with the body.
model::Flexibility read_flexibility(const h5::File& file);

}  // namespace elastogear::io
