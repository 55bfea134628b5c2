#pragma once
// Group /flexibility of a body file.

#include "elastogear/model/flexibility.h"
#include "io/hdf5/hdf5.h"

namespace elastogear::io {

/// Writes the flexibility; an empty one writes nothing.
void write_flexibility(const h5::File& file, const model::Flexibility& flexibility);
/// Reads the flexibility without G; it is empty when the file has none. F is read column by column when it is
/// asked for. The parts fit each other; model::validate compares them with the body.
model::Flexibility read_flexibility(const h5::File& file);

}  // namespace elastogear::io
