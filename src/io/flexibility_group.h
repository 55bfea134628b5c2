#pragma once
// Group /flexibility of a body file.

#include "elastogear/model/flexibility.h"
#include "hdf5.h"

namespace elastogear::io {

/// Nothing when it is empty.
void write_flexibility(const h5::File& file, const model::Flexibility& flexibility);
/// Without G, F column by column when it is asked for; empty when the file has none. What is read fits
/// together in itself; model::validate compares it with the body.
model::Flexibility read_flexibility(const h5::File& file);

}  // namespace elastogear::io
